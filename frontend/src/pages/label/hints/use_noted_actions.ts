import { useMemo } from "react";
import type { LabelActions } from "../../../labelling/commands";
import { HINT_OF_TOOL, type HintId } from "../../../labelling/hints/hints";
import { hintBook } from "../../../labelling/hints/hints_start";

/** What each action shows to be known. */
const SHOWS: readonly (readonly [keyof LabelActions, HintId])[] = [
  ["toggleKeyList", "keys"],
  ["rejectUndecided", "rest"],
  ["acceptSuggestions", "suggestions"],
  ["selectFamily", "family"],
  ["judgeFamily", "family"],
  ["rejectFor", "reason"],
  ["chooseReason", "reason"],
  ["cycleFocus", "focus"],
  ["takeOver", "take-over"],
  ["toggleTrace", "trace"],
];

/** The same actions; what is used needs no hint any more. */
export function useNotedActions<Actions extends LabelActions>(actions: Actions): Actions {
  return useMemo(() => {
    const noted: Actions = { ...actions };
    for (const [name, id] of SHOWS) {
      const act = actions[name] as (...given: unknown[]) => unknown;
      Object.assign(noted, {
        [name]: (...given: unknown[]) => {
          hintBook.learnt(id);
          return act(...given);
        },
      });
    }
    const judge: LabelActions["judge"] = (verdict) => {
      hintBook.judged();
      actions.judge(verdict);
    };
    const holdTool: LabelActions["holdTool"] = (name) => {
      hintBook.learnt(HINT_OF_TOOL[name]);
      actions.holdTool(name);
    };
    return Object.assign(noted, { judge, holdTool });
  }, [actions]);
}
