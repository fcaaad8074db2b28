/** Accepting suggestions: they become verdicts of the person who says so. */

import type { Given } from "../judging";
import type { LabelState } from "../label_state";
import { isUndecided } from "../selection";
import { suggestedAt } from "./suggestions";

/** The undecided among some candidates, each with the verdict that is suggested for it. */
export function suggestedVerdicts(state: LabelState, indices: readonly number[]): Given[] {
  return indices
    .filter((index) => isUndecided(state, index))
    .flatMap((index) => {
      const verdict = suggestedAt(state.suggesting, index);
      return verdict === null ? [] : [{ index, verdict }];
    });
}
