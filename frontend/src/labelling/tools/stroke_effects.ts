/** What a stroke does to the lines it touches: one verdict for all, or a turn of the wrong ones among them. */

import type { Verdict } from "../../api/types";
import { type LabelState, verdictAt } from "../label_state";
import { suggestionAt } from "../suggestions/suggestions";
import type { Stroke, Verdicts } from "./brush_tool";

/** Where a suggestion changes sides. */
const MIDDLE = 0.5;

/** All that is touched gets the verdict. */
export function givenToAll(verdict: Verdict): (stroke: Stroke) => Verdicts {
  return ({ touched }) => new Map([...touched].map((index) => [index, verdict]));
}

/**
 * The touched lines that a stroke turns: those it begins and ends on, and whose probability lies between the ones of
 * these two. An end beside the lines, or on one without a probability, counts as 50 %; where both do, all are turned.
 */
export function turned(
  { touched, first, last }: Stroke,
  probability: (index: number) => number | null,
): number[] {
  const [one, other] = [first, last].map((index) => (index === null ? null : probability(index)));
  if (one == null && other == null) return [...touched];
  const low = Math.min(one ?? MIDDLE, other ?? MIDDLE);
  const high = Math.max(one ?? MIDDLE, other ?? MIDDLE);
  return [...touched].filter((index) => {
    const between = probability(index);
    return index === first || index === last || (between !== null && between >= low && between <= high);
  });
}

/** The other verdict for what a stroke turns; what is ambiguous stays so. */
export function turnedVerdicts(state: LabelState, stroke: Stroke): Verdicts {
  const probability = (index: number) => suggestionAt(state.suggesting, index)?.probability ?? null;
  const verdicts = new Map<number, Verdict>();
  for (const index of turned(stroke, probability)) {
    const verdict = otherVerdict(verdictAt(state, index), probability(index));
    if (verdict !== null) verdicts.set(index, verdict);
  }
  return verdicts;
}

/** The opposite of a verdict; of an undecided line, the opposite of what its probability suggests. */
function otherVerdict(verdict: Verdict, probability: number | null): Verdict | null {
  if (verdict === "ambiguous") return null;
  if (verdict === "undecided") return (probability ?? 0) >= MIDDLE ? "reject" : "keep";
  return verdict === "keep" ? "reject" : "keep";
}
