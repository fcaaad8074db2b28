import { useQuery } from "@tanstack/react-query";
import { boardQuery } from "../api/board_queries";
import type { Submission } from "../api/board_types";
import { useOwnSubmissions } from "./submit/use_own_submissions";

export interface ComparableSubmission {
  id: number;
  method: string;
  label: string | null;
}

/** What a submission can be compared with: what stands on its version's board, and one's own others. */
export function useComparableSubmissions({ id, split, split_version }: Submission): {
  pending: boolean;
  submissions: ComparableSubmission[];
} {
  const board = useQuery(boardQuery(split.slug, split_version));
  const own = useOwnSubmissions(split.slug);
  const found = new Map<number, ComparableSubmission>();
  for (const { submission_id, method, label } of board.data?.rows ?? []) {
    if (submission_id !== null) found.set(submission_id, { id: submission_id, method: method.name, label });
  }
  for (const mine of own.data?.pages.flatMap(({ items }) => items) ?? []) {
    if (mine.status !== "scored" || mine.split_version !== split_version || found.has(mine.id)) continue;
    found.set(mine.id, { id: mine.id, method: mine.method.name, label: mine.label });
  }
  found.delete(id);
  return { pending: board.isPending || own.isPending, submissions: [...found.values()] };
}
