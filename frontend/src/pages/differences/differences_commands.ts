/** Everything the keyboard does where differences are decided. */

import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  VIEW_COMMANDS,
  type ViewActions,
} from "../../image_view/commands";
import { keymapOf } from "../../image_view/keymap";
import type { Judged } from "./differences_state";

export interface DifferencesActions extends ViewActions, ImagePageActions {
  decide(verdict: Judged): void;
  step(direction: 1 | -1): void;
  undo(): void;
  takeBack(): void;
  leave(): void;
}

export const DIFFERENCES_COMMAND_GROUPS = ["Decide", "View", "Image"] as const;

export const DIFFERENCES_COMMANDS: readonly Command<DifferencesActions>[] = [
  { id: "keep", keys: ["K"], label: "Keep", group: "Decide", run: (a) => a.decide("keep") },
  { id: "reject", keys: ["X"], label: "Reject", group: "Decide", run: (a) => a.decide("reject") },
  { id: "ambiguous", keys: ["A"], label: "Ambiguous", group: "Decide", run: (a) => a.decide("ambiguous") },
  {
    id: "undecided",
    keys: ["U"],
    label: "Take this decision back",
    group: "Decide",
    run: (a) => a.takeBack(),
  },
  {
    id: "undo",
    keys: ["Z", "Ctrl+Z"],
    label: "Take the latest one back",
    group: "Decide",
    run: (a) => a.undo(),
  },
  {
    id: "next",
    keys: ["Tab"],
    label: "Next difference",
    group: "Decide",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.step(1),
  },
  {
    id: "previous",
    keys: ["Shift+Tab"],
    label: "Previous difference",
    group: "Decide",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.step(-1),
  },
  { id: "leave", keys: ["Escape"], label: "Close; leave the image", group: "Decide", run: (a) => a.leave() },
  ...VIEW_COMMANDS,
  ...IMAGE_PAGE_COMMANDS,
];

export const DIFFERENCES_KEYMAP = keymapOf(DIFFERENCES_COMMANDS);
