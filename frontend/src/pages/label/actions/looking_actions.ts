import { toast } from "../../../design/toast";
import { toolBox } from "../../../labelling/tools/tools_start";
import type { PageActions } from "./page_actions";

/** What takes the place of all that changes something, for whoever may only look. */
export function lookingActions(why: string, next: () => void): Partial<PageActions> {
  const refuse = () => toast({ key: "looking-only", message: why });
  return {
    judge: refuse,
    undo: refuse,
    redo: refuse,
    rejectUndecided: refuse,
    acceptSuggestions: refuse,
    discard: refuse,
    toggleStages: refuse,
    holdTool: (name) => (name === "lasso" ? toolBox.hold(name) : refuse()),
    judgeFamily: refuse,
    rejectFor: refuse,
    chooseReason: refuse,
    takeOver: refuse,
    toggleTrace: refuse,
    cutLine: refuse,
    trimLine: refuse,
    joinLines: refuse,
    extendLine: refuse,
    stepJoin: () => undefined,
    finish: next,
    finishAsSuggested: next,
    setReview: async () => {
      refuse();
      return false;
    },
  };
}
