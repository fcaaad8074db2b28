/** What a model suggests for candidates. A suggestion decides nothing: a person accepts it, or judges otherwise. */

import type { ImageSuggestions, SuggestedCandidate, SuggestionThresholds, Verdict } from "../../api/types";

export type Suggestion = SuggestedCandidate;
export type Thresholds = SuggestionThresholds;

/** The suggestions of one image as the label page knows and shows them. */
export interface Suggesting {
  /** By candidate index; null where nothing is known. */
  readonly of: readonly (Suggestion | null)[];
  readonly thresholds: Thresholds;
  /** Whether they are drawn, told and accepted. */
  readonly shown: boolean;
}

export type SuggestedVerdict = Extract<Verdict, "keep" | "reject">;

export const NOT_SUGGESTING: Suggesting = { of: [], thresholds: { keep: 1, reject: 0 }, shown: false };

/** The verdict that a probability suggests; null between the thresholds, where a person has to look. */
export function verdictFor(probability: number, { keep, reject }: Thresholds): SuggestedVerdict | null {
  if (probability >= keep) return "keep";
  return probability < reject ? "reject" : null;
}

/** What is suggested for a candidate, decided or not; null where suggestions are hidden. */
export function suggestionAt(suggesting: Suggesting, index: number): Suggestion | null {
  return suggesting.shown ? (suggesting.of[index] ?? null) : null;
}

/** The verdict that is suggested for a candidate. */
export function suggestedAt(suggesting: Suggesting, index: number): SuggestedVerdict | null {
  const suggestion = suggestionAt(suggesting, index);
  return suggestion === null ? null : verdictFor(suggestion.probability, suggesting.thresholds);
}

/** Suggestions in the order of an image's candidates. */
export function byCandidate(
  candidates: readonly { readonly id: number }[],
  { segments }: Pick<ImageSuggestions, "segments">,
): (Suggestion | null)[] {
  const found = new Map(segments.map((segment) => [segment.id, segment]));
  return candidates.map(({ id }) => found.get(id) ?? null);
}

/** Whether two of them suggest the same, so that nothing has to be drawn anew. */
export function sameSuggesting(one: Suggesting, other: Suggesting): boolean {
  return (
    one.shown === other.shown &&
    one.thresholds.keep === other.thresholds.keep &&
    one.thresholds.reject === other.thresholds.reject &&
    sameSuggestions(one, other)
  );
}

/** Whether both are of the same answer, shown or not, whatever the thresholds. */
export function sameSuggestions({ of: one }: Suggesting, { of: other }: Suggesting): boolean {
  return one.length === other.length && one.every((suggestion, index) => suggestion === other[index]);
}

/** How many of some candidates are suggested to be kept and to be rejected, and how many are left to a person. */
export interface SuggestedCounts {
  readonly keep: number;
  readonly reject: number;
  readonly left: number;
}

export function countSuggested(suggesting: Suggesting, indices: Iterable<number>): SuggestedCounts {
  const counts = { keep: 0, reject: 0, left: 0 };
  for (const index of indices) counts[suggestedAt(suggesting, index) ?? "left"]++;
  return counts;
}

/** "42 kept, 101 rejected by suggestion". */
export function describeAccepted({ keep, reject }: Pick<SuggestedCounts, "keep" | "reject">): string {
  const parts = [keep > 0 ? `${keep.toLocaleString("en")} kept` : "", reject > 0 ? rejected(reject) : ""];
  return `${parts.filter((part) => part !== "").join(", ")} by suggestion`;
}

function rejected(count: number): string {
  return `${count.toLocaleString("en")} rejected`;
}
