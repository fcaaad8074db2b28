/** Numbers of a submission: which of its scores stand, and which are older. */

import type { Measured, Score, Totals } from "../../api/board_types";

/** The newest score of each protocol on the newest truth, and those that they replaced, newest first. */
export function currentScores(scores: readonly Score[]): { current: Score[]; older: Score[] } {
  const newestFirst = [...scores].sort(
    (a, b) => b.split_version - a.split_version || (b.done_at ?? "").localeCompare(a.done_at ?? ""),
  );
  const current: Score[] = [];
  const older: Score[] = [];
  for (const score of newestFirst) {
    const known = current.some(({ protocol }) => protocol === score.protocol);
    (known ? older : current).push(score);
  }
  return { current, older };
}

/** All metrics of a submission's current scores. */
export function currentTotals(scores: readonly Score[]): Totals {
  const { current } = currentScores(scores);
  return Object.assign({}, ...current.map(({ totals }) => totals)) as Totals;
}

/** The metric that a score's protocol is known by. */
export function headline({ totals }: Pick<Score, "totals">): Measured | null {
  return totals.f1 ?? totals.official_f1 ?? totals.fixed_f1 ?? null;
}
