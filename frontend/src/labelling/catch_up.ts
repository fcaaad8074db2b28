/** What an image looks like after decisions that were made elsewhere: in another tab, or by another person. */

import type { NewDecision, RejectReason, StoredDecision, Verdict } from "../api/types";
import { asRecorded, type History, type Judgement, rebuildHistory, UNDECIDED } from "./history";
import { type LabelState, reasonAt, verdictAt } from "./label_state";

export interface CaughtUp {
  readonly verdicts: readonly Verdict[];
  readonly reasons: readonly (RejectReason | null)[];
  readonly history: History;
  /** Candidates that have another verdict or another reason now, by index. */
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
 * @param edited Segments that edits by hand added or replaced: undone and done again, they come and go.
 */
export function caughtUp(
  state: LabelState,
  indexOf: ReadonlyMap<number, number>,
  decisions: readonly StoredDecision[],
  unsent: readonly NewDecision[],
  edited: ReadonlySet<number> = new Set(),
): CaughtUp {
  const stored = new Set(decisions.map((decision) => decision.client_id));
  const left = unsent.filter((decision) => !stored.has(decision.client_id));
  const latest = new Map<number, Judgement>();
  for (const { segment_id, verdict, reason } of decisions) latest.set(segment_id, { verdict, reason });
  const recorded = asRecorded(left, (id) => latest.get(id) ?? UNDECIDED);
  for (const { segment_id, verdict, reason = null } of left) latest.set(segment_id, { verdict, reason });

  const verdicts = [...state.verdicts];
  const reasons = [...state.reasons];
  const changed: number[] = [];
  for (const [segmentId, { verdict, reason }] of latest) {
    const index = indexOf.get(segmentId);
    if (index === undefined) continue;
    if (verdictAt(state, index) === verdict && reasonAt(state, index) === reason) continue;
    verdicts[index] = verdict;
    reasons[index] = reason;
    changed.push(index);
  }
  return {
    verdicts,
    reasons,
    history: rebuildHistory([...decisions, ...recorded], (id) => indexOf.has(id) || edited.has(id)),
    changed,
    replaced: changed.filter((index) => verdictAt(state, index) !== "undecided"),
  };
}
