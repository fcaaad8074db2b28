/** Everything the keyboard does on the label page: one object per command. */

import type { Verdict } from "../api/types";

/** What commands act on; the page provides it. */
export interface LabelActions {
  step(direction: 1 | -1): void;
  judge(verdict: Verdict): void;
  undo(): void;
  redo(): void;
  rejectUndecided(): void;
  toggleRejected(): void;
  finish(): void;
  discard(): void;
  goToImage(direction: 1 | -1): void;
  leaveSelection(): void;
  toggleStages(): void;
  stepJoin(direction: 1 | -1): void;
  toggleKeyList(): void;
  fit(): void;
  zoom(direction: 1 | -1): void;
  pan(dx: number, dy: number): void;
}

export const COMMAND_GROUPS = ["Judge", "Move", "View", "Image"] as const;
export type CommandGroup = (typeof COMMAND_GROUPS)[number];

export interface Command {
  readonly id: string;
  /** Alternatives; each is one key with its modifiers, as in "Shift+Tab". */
  readonly keys: readonly string[];
  readonly label: string;
  readonly group: CommandGroup;
  /** The key has a meaning of its own on buttons and links, so it acts on the image alone. */
  readonly onImageOnly?: boolean;
  /** Holding the key repeats the command. */
  readonly repeats?: boolean;
  readonly run: (actions: LabelActions) => void;
}

/** Share of the screen that an arrow key moves the view by. */
const PAN_STEP = 0.15;

export const COMMANDS: readonly Command[] = [
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
    run: (a) => a.leaveSelection(),
  },
  { id: "hide-rejected", keys: ["H"], label: "Hide rejected", group: "View", run: (a) => a.toggleRejected() },
  { id: "stages", keys: ["I"], label: "How it was found", group: "View", run: (a) => a.toggleStages() },
  {
    id: "next-join",
    keys: ["J"],
    label: "… its next join",
    group: "View",
    repeats: true,
    run: (a) => a.stepJoin(1),
  },
  {
    id: "previous-join",
    keys: ["Shift+J"],
    label: "… its previous join",
    group: "View",
    repeats: true,
    run: (a) => a.stepJoin(-1),
  },
  { id: "fit", keys: ["F"], label: "Fit the image", group: "View", run: (a) => a.fit() },
  { id: "zoom-in", keys: ["+", "="], label: "Zoom in", group: "View", repeats: true, run: (a) => a.zoom(1) },
  { id: "zoom-out", keys: ["-"], label: "Zoom out", group: "View", repeats: true, run: (a) => a.zoom(-1) },
  ...(
    [
      ["ArrowLeft", "left", PAN_STEP, 0],
      ["ArrowRight", "right", -PAN_STEP, 0],
      ["ArrowUp", "up", 0, PAN_STEP],
      ["ArrowDown", "down", 0, -PAN_STEP],
    ] as const
  ).map(
    ([key, side, dx, dy]): Command => ({
      id: `pan-${side}`,
      keys: [key],
      label: `Move ${side}`,
      group: "View",
      onImageOnly: true,
      repeats: true,
      run: (a) => a.pan(dx, dy),
    }),
  ),
  {
    id: "finish",
    keys: ["Enter"],
    label: "Image done, on to the next",
    group: "Image",
    onImageOnly: true,
    run: (a) => a.finish(),
  },
  {
    id: "discard",
    keys: ["D"],
    label: "Discard the image, with a reason",
    group: "Image",
    run: (a) => a.discard(),
  },
  { id: "next-image", keys: ["N", "]"], label: "Next image", group: "Image", run: (a) => a.goToImage(1) },
  {
    id: "previous-image",
    keys: ["P", "["],
    label: "Previous image",
    group: "Image",
    run: (a) => a.goToImage(-1),
  },
  {
    id: "key-list",
    keys: ["?"],
    label: "Show or hide this list",
    group: "Image",
    run: (a) => a.toggleKeyList(),
  },
];

const KEY_CAPS: Readonly<Record<string, string>> = {
  Escape: "Esc",
  ArrowLeft: "←",
  ArrowRight: "→",
  ArrowUp: "↑",
  ArrowDown: "↓",
  "-": "−",
};

/** The key caps of one alternative: "Shift+Tab" gives Shift and Tab. */
export function keyCaps(key: string): string[] {
  if (key === "+") return ["+"];
  return key.split("+").map((part) => KEY_CAPS[part] ?? part);
}
