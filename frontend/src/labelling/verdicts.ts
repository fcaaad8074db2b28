import type { Verdict, VerdictCounts } from "../api/types";

export const VERDICTS = ["undecided", "keep", "reject", "ambiguous"] as const satisfies readonly Verdict[];

export function countVerdicts(verdicts: Iterable<Verdict>): VerdictCounts {
  const counts: VerdictCounts = { undecided: 0, keep: 0, reject: 0, ambiguous: 0 };
  for (const verdict of verdicts) counts[verdict]++;
  return counts;
}
