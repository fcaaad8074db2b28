/** What the label page knows of one image, and the pure questions one asks it. */

import type { RejectReason, SegmentFacts, Verdict, VerdictCounts } from "../api/types";
import type { History } from "./history";
import type { ReviewOrder } from "./order";
import { isInRanges, NO_RANGES, type Ranges } from "./ranges";
import type { Suggesting } from "./suggestions/suggestions";

/** Which candidates are shown. */
export interface Shown {
  readonly verdicts: Readonly<Record<Verdict, boolean>>;
  /** Candidates that fail the straightness test. */
  readonly bent: boolean;
  /** By length, score and residual. */
  readonly ranges: Ranges;
  /** What becomes of the others on the image while something is selected. */
  readonly focus: Focus;
}

export const FOCUSES = ["all", "dim", "solo"] as const;
/** All are drawn alike; the others are faint; the others aren't drawn. */
export type Focus = (typeof FOCUSES)[number];

export interface LabelState {
  readonly candidates: readonly SegmentFacts[];
  /** By candidate index. */
  readonly verdicts: readonly Verdict[];
  /** Why each was rejected, by candidate index; null where nobody said, and for every other verdict. */
  readonly reasons: readonly (RejectReason | null)[];
  readonly counts: VerdictCounts;
  /** Candidate indices in the order of review. */
  readonly sequence: readonly number[];
  readonly order: ReviewOrder;
  /** The candidate that the panel shows, the one that was selected last. */
  readonly selected: number | null;
  /** All selected candidates, by index: empty exactly where `selected` is null, else with it. */
  readonly selection: readonly number[];
  readonly shown: Shown;
  readonly suggesting: Suggesting;
  readonly history: History;
  /** Rises whenever the view should go to the selected candidate. */
  readonly followRequest: number;
}

export const SHOW_ALL: Shown = {
  verdicts: { undecided: true, keep: true, reject: true, ambiguous: true },
  bent: true,
  ranges: NO_RANGES,
  focus: "all",
};

export function isBent(state: LabelState, index: number): boolean {
  return state.candidates[index]?.straight === false;
}

export function verdictAt(state: LabelState, index: number): Verdict {
  return state.verdicts[index] ?? "undecided";
}

export function reasonAt(state: LabelState, index: number): RejectReason | null {
  return state.reasons[index] ?? null;
}

export function isShown(state: LabelState, index: number): boolean {
  const { verdicts, bent, ranges } = state.shown;
  const candidate = state.candidates[index];
  if (candidate === undefined || !verdicts[verdictAt(state, index)]) return false;
  return (bent || candidate.straight) && isInRanges(candidate, ranges);
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
  if (state.selection.length > 1) return `${state.selection.length} candidates selected`;
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
