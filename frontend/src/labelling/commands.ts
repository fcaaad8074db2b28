/** Everything the keyboard does on the label page. */

import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  VIEW_COMMANDS,
  type ViewActions,
} from "../image_view/commands";
import { keymapOf } from "../image_view/keymap";
import { PAGES_COMMANDS, type PagesActions } from "./commands_pages";
import {
  FINISH,
  HIDE_REJECTED,
  MOVE_COMMANDS,
  REDO,
  REJECT_UNDECIDED,
  type ReviewActions,
  UNDO,
  VERDICT_COMMANDS,
} from "./commands_review";
import { TOOL_COMMANDS, type ToolActions } from "./commands_tools";
import { DRAWING_COMMANDS, type DrawingActions } from "./drawing/commands_drawing";
import { SUGGESTION_COMMANDS, type SuggestionActions } from "./suggestions/commands_suggestions";
import { VIEWS_COMMANDS, type ViewsActions } from "./views/commands_views";

/** What commands act on; the page provides it. */
export interface LabelActions
  extends ViewActions,
    ImagePageActions,
    ReviewActions,
    ViewsActions,
    ToolActions,
    DrawingActions,
    SuggestionActions,
    PagesActions {
  /** Accepts the suggestions on the screen where nothing is decided yet; then the image is done. */
  finishAsSuggested(): void;
  discard(): void;
  toggleStages(): void;
  stepJoin(direction: 1 | -1): void;
}

export const COMMAND_GROUPS = ["Judge", "Many", "Reject because", "Draw", "Move", "View", "Image"] as const;

export const COMMANDS: readonly Command<LabelActions>[] = [
  ...VERDICT_COMMANDS,
  REJECT_UNDECIDED,
  ...SUGGESTION_COMMANDS,
  UNDO,
  REDO,
  ...MOVE_COMMANDS,
  HIDE_REJECTED,
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
  FINISH,
  {
    id: "finish-as-suggested",
    keys: ["Shift+Enter"],
    label: "The rest as suggested, and done",
    group: "Image",
    onImageOnly: true,
    run: (a) => a.finishAsSuggested(),
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
