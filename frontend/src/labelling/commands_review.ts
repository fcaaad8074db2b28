/** Keys that every review of candidates has, whoever's it is. */

import type { Verdict } from "../api/types";
import type { Command } from "../image_view/commands";

export interface ReviewActions {
  judge(verdict: Verdict): void;
  rejectUndecided(): void;
  undo(): void;
  redo(): void;
  step(direction: 1 | -1): void;
  leaveSelection(): void;
  toggleRejected(): void;
  finish(): void;
}

export const VERDICT_COMMANDS: readonly Command<Pick<ReviewActions, "judge">>[] = [
  { id: "keep", keys: ["K"], label: "Keep", group: "Judge", run: (a) => a.judge("keep") },
  { id: "reject", keys: ["X"], label: "Reject", group: "Judge", run: (a) => a.judge("reject") },
  { id: "ambiguous", keys: ["A"], label: "Ambiguous", group: "Judge", run: (a) => a.judge("ambiguous") },
  {
    id: "undecided",
    keys: ["U"],
    label: "Back to undecided",
    group: "Judge",
    run: (a) => a.judge("undecided"),
  },
];

export const REJECT_UNDECIDED: Command<Pick<ReviewActions, "rejectUndecided">> = {
  id: "reject-undecided",
  keys: ["R"],
  label: "Reject all undecided",
  group: "Judge",
  run: (a) => a.rejectUndecided(),
};

export const UNDO: Command<Pick<ReviewActions, "undo">> = {
  id: "undo",
  keys: ["Z", "Ctrl+Z"],
  label: "Undo",
  group: "Judge",
  repeats: true,
  run: (a) => a.undo(),
};

export const REDO: Command<Pick<ReviewActions, "redo">> = {
  id: "redo",
  keys: ["Shift+Z", "Ctrl+Shift+Z", "Ctrl+Y"],
  label: "Redo",
  group: "Judge",
  repeats: true,
  run: (a) => a.redo(),
};

export const MOVE_COMMANDS: readonly Command<Pick<ReviewActions, "step" | "leaveSelection">>[] = [
  {
    id: "next",
    keys: ["Tab"],
    label: "Next candidate",
    group: "Move",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.step(1),
  },
  {
    id: "previous",
    keys: ["Shift+Tab"],
    label: "Previous candidate",
    group: "Move",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.step(-1),
  },
  {
    id: "leave",
    keys: ["Escape"],
    label: "Close; deselect; leave the image",
    group: "Move",
    run: (a) => a.leaveSelection(),
  },
];

export const HIDE_REJECTED: Command<Pick<ReviewActions, "toggleRejected">> = {
  id: "hide-rejected",
  keys: ["H"],
  label: "Hide rejected",
  group: "View",
  run: (a) => a.toggleRejected(),
};

export const FINISH: Command<Pick<ReviewActions, "finish">> = {
  id: "finish",
  keys: ["Enter"],
  label: "Image done, on to the next",
  group: "Image",
  onImageOnly: true,
  run: (a) => a.finish(),
};
