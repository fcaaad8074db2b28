/** What an image looks like after decisions that were made elsewhere: in another tab, or by another person. */

import type { NewDecision, StoredDecision, Verdict } from "../api/types";
import { asRecorded, type History, rebuildHistory } from "./history";
import { type LabelState, verdictAt } from "./label_state";

export interface CaughtUp {
  readonly verdicts: readonly Verdict[];
  readonly history: History;
  /** Candidates that have another verdict now, by index. */
  readonly changed: readonly number[];
  /** Those among them that had been judged here, differently. */
  readonly replaced: readonly number[];
}

/**
 * The state after the server's decisions, with what it doesn't know yet on top.
 *
 * @param indexOf Candidate index by segment id.
 * @param decisions All of the image, oldest first; those on candidates of earlier runs count for nothing.
 * @param unsent Decisions of here; those that the server has by now count once.
 */
export function caughtUp(
  state: LabelState,
  indexOf: ReadonlyMap<number, number>,
  decisions: readonly StoredDecision[],
  unsent: readonly NewDecision[],
): CaughtUp {
  const stored = new Set(decisions.map((decision) => decision.client_id));
  const left = unsent.filter((decision) => !stored.has(decision.client_id));
  const latest = new Map<number, Verdict>();
  for (const { segment_id, verdict } of decisions) latest.set(segment_id, verdict);
  const recorded = asRecorded(left, (id) => latest.get(id) ?? "undecided");
  for (const { segment_id, verdict } of left) latest.set(segment_id, verdict);

  const verdicts = [...state.verdicts];
  const changed: number[] = [];
  for (const [segmentId, verdict] of latest) {
    const index = indexOf.get(segmentId);
    if (index === undefined || verdictAt(state, index) === verdict) continue;
    verdicts[index] = verdict;
    changed.push(index);
  }
  return {
    verdicts,
    history: rebuildHistory([...decisions, ...recorded], (id) => indexOf.has(id)),
    changed,
    replaced: changed.filter((index) => verdictAt(state, index) !== "undecided"),
  };
}
