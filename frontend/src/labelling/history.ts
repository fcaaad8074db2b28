/**
 * Undo and redo over groups of changes: what one key did is undone by one key.
 *
 * The server stores every decision, undos included; the two stacks are rebuilt from its list, so undo works
 * across reloads and never reaches into another image.
 */

import type { NewDecision, RejectReason, StoredDecision, Verdict } from "../api/types";

export interface VerdictChange {
  readonly segmentId: number;
  readonly from: Verdict;
  readonly to: Verdict;
  /** Why it was rejected before, and why it is now; null for every other verdict, or where nobody said. */
  readonly reasons: { readonly from: RejectReason | null; readonly to: RejectReason | null };
}

export interface ChangeGroup {
  readonly id: string;
  readonly changes: readonly VerdictChange[];
}

export interface History {
  /** What can be undone, the latest last. */
  readonly done: readonly ChangeGroup[];
  /** What can be done again, the latest undone last. */
  readonly undone: readonly ChangeGroup[];
}

export const NO_HISTORY: History = { done: [], undone: [] };

/** A new judgement: whatever was undone before it can't be redone any more. */
export function pushed(history: History, group: ChangeGroup): History {
  return { done: [...history.done, group], undone: [] };
}

/** The history after undoing a group, by default the latest; unchanged where there is none. */
export function undone(history: History, id = history.done.at(-1)?.id): History {
  const group = history.done.find((candidate) => candidate.id === id);
  if (group === undefined) return history;
  return { done: history.done.filter((other) => other !== group), undone: [...history.undone, group] };
}

export function redone(history: History, id = history.undone.at(-1)?.id): History {
  const group = history.undone.find((candidate) => candidate.id === id);
  if (group === undefined) return history;
  return { done: [...history.done, group], undone: history.undone.filter((other) => other !== group) };
}

type Recorded = Pick<StoredDecision, "segment_id" | "verdict" | "previous" | "group_id"> & {
  kind: StoredDecision["kind"];
  target_group_id?: string | null;
  reason?: RejectReason | null;
  /** Where it isn't given, the reason follows from the decisions before. */
  previous_reason?: RejectReason | null;
};

/** Kinds that a person undoes; what was carried or imported came with the candidates. */
const UNDOABLE: readonly string[] = ["judge", "accept", "take_over"];

/**
 * The two stacks after a list of decisions, oldest first.
 *
 * @param isCurrent Whether a segment is still shown; a newer run may have replaced some that were judged.
 */
export function rebuildHistory(
  decisions: Iterable<Recorded>,
  isCurrent: (segmentId: number) => boolean,
): History {
  let history = NO_HISTORY;
  const moved = new Set<string>();
  const reasons = new Map<number, RejectReason | null>();
  for (const decision of decisions) {
    const { segment_id: segmentId, reason = null } = decision;
    const before = decision.previous_reason ?? reasons.get(segmentId) ?? null;
    reasons.set(segmentId, reason);
    if (UNDOABLE.includes(decision.kind)) history = appended(history, decision, { from: before, to: reason });
    else if ((decision.kind === "undo" || decision.kind === "redo") && !moved.has(decision.group_id)) {
      moved.add(decision.group_id);
      const move = decision.kind === "undo" ? undone : redone;
      history = move(history, decision.target_group_id ?? undefined);
    }
  }
  return { done: withCurrent(history.done, isCurrent), undone: withCurrent(history.undone, isCurrent) };
}

function appended(history: History, decision: Recorded, reasons: VerdictChange["reasons"]): History {
  const change = { segmentId: decision.segment_id, from: decision.previous, to: decision.verdict, reasons };
  const last = history.done.at(-1);
  if (last?.id !== decision.group_id) return pushed(history, { id: decision.group_id, changes: [change] });
  const longer = { id: last.id, changes: [...last.changes, change] };
  return { done: [...history.done.slice(0, -1), longer], undone: [] };
}

function withCurrent(groups: readonly ChangeGroup[], isCurrent: (id: number) => boolean): ChangeGroup[] {
  return groups
    .map((group) => ({ id: group.id, changes: group.changes.filter((c) => isCurrent(c.segmentId)) }))
    .filter((group) => group.changes.length > 0);
}

/** A candidate's verdict, with the reason of a rejection. */
export interface Judgement {
  readonly verdict: Verdict;
  readonly reason: RejectReason | null;
}

export const UNDECIDED: Judgement = { verdict: "undecided", reason: null };

/** Decisions known here only, in the form of the server's list: each one's `previous` is what stood before. */
export function asRecorded(
  decisions: readonly NewDecision[],
  judgementOf: (segmentId: number) => Judgement,
): Recorded[] {
  const current = new Map<number, Judgement>();
  return decisions.map((decision) => {
    const before = current.get(decision.segment_id) ?? judgementOf(decision.segment_id);
    current.set(decision.segment_id, { verdict: decision.verdict, reason: decision.reason ?? null });
    return { ...decision, previous: before.verdict, previous_reason: before.reason };
  });
}

/** "Undone: keep", "Undone: reject of 12 candidates", "Redone: back to undecided". */
export function describeReplay(kind: "undo" | "redo", { changes }: ChangeGroup): string {
  const verdict = changes[0]?.to ?? "undecided";
  const what = verdict === "undecided" ? "back to undecided" : verdict;
  const extent = changes.length > 1 ? ` of ${changes.length.toLocaleString("en")} candidates` : "";
  return `${kind === "undo" ? "Undone" : "Redone"}: ${what}${extent}`;
}
