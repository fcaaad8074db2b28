/** Versions of a method: its submissions, split by split and over time. */

import type { Submission } from "../../api/board_types";
import { rankTotals } from "../submission_table";

export interface VersionPoint {
  id: number;
  label: string;
  /** ms since 1970. */
  time: number;
  value: number;
  low: number | null;
  high: number | null;
}

export interface OnSplit {
  split: Submission["split"];
  submissions: Submission[];
}

/** Grouped by split, the split of the newest submission first; within one the newest first. */
export function bySplit(submissions: readonly Submission[]): OnSplit[] {
  const groups = new Map<string, OnSplit>();
  for (const submission of [...submissions].sort((a, b) => b.created_at.localeCompare(a.created_at))) {
    const group = groups.get(submission.split.slug);
    if (group) group.submissions.push(submission);
    else groups.set(submission.split.slug, { split: submission.split, submissions: [submission] });
  }
  return [...groups.values()];
}

/** The scored ones, oldest first. */
export function versionPoints(submissions: readonly Submission[]): VersionPoint[] {
  return submissions
    .flatMap((submission) => {
      const f1 = rankTotals(submission)?.f1;
      if (submission.status !== "scored" || !f1 || f1.value === null) return [];
      const { id, label, created_at } = submission;
      return [
        {
          id,
          label: label ?? `Submission ${id}`,
          time: Date.parse(created_at),
          value: f1.value,
          low: f1.low,
          high: f1.high,
        },
      ];
    })
    .sort((a, b) => a.time - b.time);
}
