/** From what a key press judges to what changes, and to the decisions that the server is told. */

import type { NewDecision, RejectReason, Verdict } from "../api/types";
import type { VerdictChange } from "./history";
import { type LabelState, reasonAt, verdictAt } from "./label_state";
import { suggestionAt } from "./suggestions/suggestions";
import { countVerdicts } from "./verdicts";

/** A judgement of one candidate, by index. */
export interface Given {
  readonly index: number;
  readonly verdict: Verdict;
  /** Why it is rejected; left out, a candidate that stays rejected keeps the reason it has. */
  readonly reason?: RejectReason | null | undefined;
  /** The probability of keep that the person saw. */
  readonly suggestion?: number | null | undefined;
}

export interface JudgeOptions {
  readonly reason?: RejectReason | null | undefined;
  readonly kind?: "judge" | "accept" | "take_over" | undefined;
}

/** What one key press records. */
export interface Act {
  readonly kind: NewDecision["kind"];
  readonly groupId: string;
  /** The group that is undone or redone. */
  readonly targetGroupId?: string;
  /** Probabilities that were shown, by segment id. */
  readonly suggestions?: ReadonlyMap<number, number | null>;
}

function changeOf(state: LabelState, { index, verdict, reason }: Given): VerdictChange {
  const candidate = state.candidates[index];
  if (candidate === undefined) throw new RangeError(`There is no candidate ${index}.`);
  const before = reasonAt(state, index);
  const after = verdict !== "reject" ? null : reason === undefined ? before : reason;
  return {
    segmentId: candidate.id,
    from: verdictAt(state, index),
    to: verdict,
    reasons: { from: before, to: after },
  };
}

/** Whether anything is another one after it. */
function isChange({ from, to, reasons }: VerdictChange): boolean {
  return from !== to || reasons.from !== reasons.to;
}

export function reversed({ segmentId, from, to, reasons }: VerdictChange): VerdictChange {
  return { segmentId, from: to, to: from, reasons: { from: reasons.to, to: reasons.from } };
}

/** What some judgements change. */
export interface Judged {
  readonly changes: readonly VerdictChange[];
  /** The probabilities that were shown, by segment id. */
  readonly suggestions: ReadonlyMap<number, number | null>;
}

/** Judgements that leave things as they are change nothing. */
export function judgedBy(state: LabelState, given: readonly Given[]): Judged {
  const changes: VerdictChange[] = [];
  const suggestions = new Map<number, number | null>();
  for (const wish of given) {
    const change = changeOf(state, wish);
    if (!isChange(change)) continue;
    changes.push(change);
    suggestions.set(change.segmentId, probabilityShown(state, wish));
  }
  return { changes, suggestions };
}

function probabilityShown({ suggesting }: LabelState, { index, suggestion }: Given): number | null {
  return suggestion ?? suggestionAt(suggesting, index)?.probability ?? null;
}

/** The verdicts and reasons after some changes. */
export function changed(
  state: LabelState,
  indexOf: ReadonlyMap<number, number>,
  changes: readonly VerdictChange[],
): Pick<LabelState, "verdicts" | "reasons" | "counts"> {
  const verdicts = [...state.verdicts];
  const reasons = [...state.reasons];
  for (const { segmentId, to, reasons: why } of changes) {
    const index = indexOf.get(segmentId);
    if (index === undefined) continue;
    verdicts[index] = to;
    reasons[index] = why.to;
  }
  return { verdicts, reasons, counts: countVerdicts(verdicts) };
}

/** @param elapsed How long the person took for all of them (ms). */
export function decisionsOf(
  changes: readonly VerdictChange[],
  { kind, groupId, targetGroupId, suggestions }: Act,
  elapsed: number,
  newId: () => string,
): NewDecision[] {
  return changes.map(({ segmentId, to, reasons }, place) => {
    const suggestion = suggestions?.get(segmentId) ?? null;
    return {
      client_id: newId(),
      group_id: groupId,
      kind,
      ...(targetGroupId === undefined ? {} : { target_group_id: targetGroupId }),
      segment_id: segmentId,
      verdict: to,
      // One key press took this time, however many candidates it judged.
      elapsed_ms: place === 0 ? elapsed : null,
      ...(reasons.to === null ? {} : { reason: reasons.to }),
      ...(suggestion === null ? {} : { suggestion }),
    };
  });
}
