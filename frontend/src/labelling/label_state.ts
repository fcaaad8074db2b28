/** What the label page knows of one image, and the pure questions one asks it. */

import type { SegmentFacts, Verdict, VerdictCounts } from "../api/types";
import type { History } from "./history";
import type { ReviewOrder } from "./order";

/** Which candidates are shown. */
export interface Shown {
  readonly verdicts: Readonly<Record<Verdict, boolean>>;
  /** Candidates that fail the straightness test. */
  readonly bent: boolean;
}

export interface LabelState {
  readonly candidates: readonly SegmentFacts[];
  /** By candidate index. */
  readonly verdicts: readonly Verdict[];
  readonly counts: VerdictCounts;
  /** Candidate indices in the order of review. */
  readonly sequence: readonly number[];
  readonly order: ReviewOrder;
  readonly selected: number | null;
  readonly shown: Shown;
  readonly history: History;
  /** Rises whenever the view should go to the selected candidate. */
  readonly followRequest: number;
}

export const SHOW_ALL: Shown = {
  verdicts: { undecided: true, keep: true, reject: true, ambiguous: true },
  bent: true,
};

export function isBent(state: LabelState, index: number): boolean {
  return state.candidates[index]?.straight === false;
}

export function verdictAt(state: LabelState, index: number): Verdict {
  return state.verdicts[index] ?? "undecided";
}

export function isShown(state: LabelState, index: number): boolean {
  return state.shown.verdicts[verdictAt(state, index)] && (state.shown.bent || !isBent(state, index));
}

export function judgedCount({ counts }: LabelState): number {
  return counts.keep + counts.reject + counts.ambiguous;
}

/** 1-based place of the selected candidate in the order of review. */
export function selectedPlace(state: LabelState): number | null {
  return state.selected === null ? null : state.sequence.indexOf(state.selected) + 1;
}

/** What a screen reader says of the selection. */
export function describeSelection(state: LabelState): string {
  const candidate = state.selected === null ? undefined : state.candidates[state.selected];
  if (state.selected === null || candidate === undefined) return "No candidate selected";
  const parts = [
    `Candidate ${selectedPlace(state)} of ${state.candidates.length}`,
    verdictAt(state, state.selected),
    `${Math.round(candidate.length)} pixels long`,
  ];
  if (candidate.score !== null) parts.push(`score ${candidate.score.toFixed(2)}`);
  if (candidate.straight === false) parts.push("fails the straightness test");
  return parts.join(", ");
}
