/** Everything the keyboard does on the label page. */

import type { Verdict } from "../api/types";
import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  VIEW_COMMANDS,
  type ViewActions,
} from "../image_view/commands";
import { keymapOf } from "../image_view/keymap";
import { PAGES_COMMANDS, type PagesActions } from "./commands_pages";
import { TOOL_COMMANDS, type ToolActions } from "./commands_tools";
import { DRAWING_COMMANDS, type DrawingActions } from "./drawing/commands_drawing";
import { SUGGESTION_COMMANDS, type SuggestionActions } from "./suggestions/commands_suggestions";
import { VIEWS_COMMANDS, type ViewsActions } from "./views/commands_views";

/** What commands act on; the page provides it. */
export interface LabelActions
  extends ViewActions,
    ImagePageActions,
    ViewsActions,
    ToolActions,
    DrawingActions,
    SuggestionActions,
    PagesActions {
  step(direction: 1 | -1): void;
  judge(verdict: Verdict): void;
  undo(): void;
  redo(): void;
  rejectUndecided(): void;
  toggleRejected(): void;
  finish(): void;
  discard(): void;
  leaveSelection(): void;
  toggleStages(): void;
  stepJoin(direction: 1 | -1): void;
}

export const COMMAND_GROUPS = ["Judge", "Many", "Reject because", "Draw", "Move", "View", "Image"] as const;

export const COMMANDS: readonly Command<LabelActions>[] = [
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
  ...SUGGESTION_COMMANDS,
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
  ...VIEW_COMMANDS,
  ...VIEWS_COMMANDS,
  ...TOOL_COMMANDS,
  ...DRAWING_COMMANDS,
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
  ...IMAGE_PAGE_COMMANDS,
  ...PAGES_COMMANDS,
];

export const KEYMAP = keymapOf(COMMANDS);
