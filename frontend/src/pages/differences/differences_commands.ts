/** Everything the keyboard does where differences are decided: the label page's keys, as far as they apply. */

import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  reworded,
  VIEW_COMMANDS,
  type ViewActions,
} from "../../image_view/commands";
import { keymapOf } from "../../image_view/keymap";
import { MOVE_COMMANDS, type ReviewActions, UNDO, VERDICT_COMMANDS } from "../../labelling/commands_review";

export interface DifferencesActions
  extends ViewActions,
    ImagePageActions,
    Pick<ReviewActions, "judge" | "undo" | "step" | "leaveSelection"> {}

const DECIDE = "Decide";

export const DIFFERENCES_COMMAND_GROUPS = [DECIDE, "View", "Image"] as const;

const DECIDE_COMMANDS: readonly Command<DifferencesActions>[] = reworded<DifferencesActions>(
  // Each one taken back is asked of the server first: holding the key would ask for the same one again.
  [...VERDICT_COMMANDS, { ...UNDO, repeats: false }, ...MOVE_COMMANDS],
  {
    undecided: "Take this decision back",
    undo: "Take the latest one back",
    next: "Next difference",
    previous: "Previous difference",
    leave: "Close; leave the image",
  },
).map((command) => ({ ...command, group: DECIDE }));

export const DIFFERENCES_COMMANDS: readonly Command<DifferencesActions>[] = [
  ...DECIDE_COMMANDS,
  ...VIEW_COMMANDS,
  ...IMAGE_PAGE_COMMANDS,
];

export const DIFFERENCES_KEYMAP = keymapOf(DIFFERENCES_COMMANDS);
