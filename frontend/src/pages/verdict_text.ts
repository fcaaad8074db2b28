import type { VerdictCounts } from "../api/types";
import { formatCount } from "../design/format";

const WORDS = [
  ["keep", "kept"],
  ["ambiguous", "ambiguous"],
  ["reject", "rejected"],
  ["undecided", "undecided"],
] as const;

/** "310 kept, 402 rejected, 11,765 undecided": what there is none of is left out. */
export function verdictText(counts: VerdictCounts): string {
  const parts = WORDS.filter(([verdict]) => counts[verdict] > 0);
  if (parts.length === 0) return "No candidates";
  return parts.map(([verdict, word]) => `${formatCount(counts[verdict])} ${word}`).join(", ");
}
