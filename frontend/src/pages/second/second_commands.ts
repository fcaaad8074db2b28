/** Everything the keyboard does in a second review: the label page's keys, as far as they need nobody else's work. */

import type { Verdict } from "../../api/types";
import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  VIEW_COMMANDS,
  type ViewActions,
} from "../../image_view/commands";
import { keymapOf } from "../../image_view/keymap";

export interface SecondActions extends ViewActions, Pick<ImagePageActions, "toggleKeyList"> {
  judge(verdict: Verdict): void;
  rejectUndecided(): void;
  undo(): void;
  redo(): void;
  step(direction: 1 | -1): void;
  leave(): void;
  toggleRejected(): void;
  finish(): void;
}

export const SECOND_COMMAND_GROUPS = ["Judge", "Move", "View", "Image"] as const;

const KEY_LIST = IMAGE_PAGE_COMMANDS.filter(({ id }) => id === "key-list").map(
  (command): Command<SecondActions> => ({ ...command, run: (a) => a.toggleKeyList() }),
);

export const SECOND_COMMANDS: readonly Command<SecondActions>[] = [
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
  {
    id: "reject-undecided",
    keys: ["R"],
    label: "Reject all undecided",
    group: "Judge",
    run: (a) => a.rejectUndecided(),
  },
  { id: "undo", keys: ["Z", "Ctrl+Z"], label: "Undo", group: "Judge", repeats: true, run: (a) => a.undo() },
  {
    id: "redo",
    keys: ["Shift+Z", "Ctrl+Shift+Z", "Ctrl+Y"],
    label: "Redo",
    group: "Judge",
    repeats: true,
    run: (a) => a.redo(),
  },
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
    run: (a) => a.leave(),
  },
  { id: "hide-rejected", keys: ["H"], label: "Hide rejected", group: "View", run: (a) => a.toggleRejected() },
  ...VIEW_COMMANDS,
  {
    id: "finish",
    keys: ["Enter"],
    label: "Second review done, on to the next",
    group: "Image",
    onImageOnly: true,
    run: (a) => a.finish(),
  },
  ...KEY_LIST,
];

export const SECOND_KEYMAP = keymapOf(SECOND_COMMANDS);
