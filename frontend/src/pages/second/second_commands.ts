/** Everything the keyboard does in a second review: the label page's keys, as far as they need nobody else's work. */

import {
  type Command,
  type ImagePageActions,
  reworded,
  TOGGLE_KEY_LIST,
  VIEW_COMMANDS,
  type ViewActions,
} from "../../image_view/commands";
import { keymapOf } from "../../image_view/keymap";
import {
  FINISH,
  HIDE_REJECTED,
  MOVE_COMMANDS,
  REDO,
  REJECT_UNDECIDED,
  type ReviewActions,
  UNDO,
  VERDICT_COMMANDS,
} from "../../labelling/commands_review";

export interface SecondActions extends ViewActions, ReviewActions, Pick<ImagePageActions, "toggleKeyList"> {}

export const SECOND_COMMAND_GROUPS = ["Judge", "Move", "View", "Image"] as const;

export const SECOND_COMMANDS: readonly Command<SecondActions>[] = [
  ...VERDICT_COMMANDS,
  REJECT_UNDECIDED,
  UNDO,
  REDO,
  ...MOVE_COMMANDS,
  HIDE_REJECTED,
  ...VIEW_COMMANDS,
  ...reworded([FINISH], { finish: "Second review done, on to the next" }),
  TOGGLE_KEY_LIST,
];

export const SECOND_KEYMAP = keymapOf(SECOND_COMMANDS);
