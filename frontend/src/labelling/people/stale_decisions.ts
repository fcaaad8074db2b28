/** Decisions that the server holds back because another person decided differently meanwhile. */

import type { Problem, Verdict } from "../../api/types";
import type { OutboxEntry } from "../outbox_storage";

export const STALE_VERDICT = "stale-verdict";

/** The other person's verdict. */
export interface TheirVerdict {
  readonly verdict: Verdict;
  readonly person: string | null;
  readonly created_at: string;
  readonly decision_id: number;
}

/** An own decision that waits for an answer: whose verdict is to stand. */
export interface StaleDecision extends OutboxEntry {
  readonly theirs: TheirVerdict;
}

/** Both verdicts on one candidate, and the own decisions that led to mine. */
export interface StaleCandidate {
  readonly segmentId: number;
  readonly mine: Verdict;
  readonly theirs: TheirVerdict;
  readonly decisions: readonly StaleDecision[];
}

interface Conflict {
  readonly client_id: string;
  readonly theirs: TheirVerdict;
}

/** What of a refused batch is stale, and what may be sent without it. */
export function sortedOut(
  batch: readonly OutboxEntry[],
  problem: Problem,
): { stale: StaleDecision[]; rest: OutboxEntry[] } {
  const conflicts = conflictsOf(problem);
  const stale: StaleDecision[] = [];
  const rest: OutboxEntry[] = [];
  for (const entry of batch) {
    const theirs = conflicts.get(entry.decision.client_id);
    if (theirs === undefined) rest.push(entry);
    else stale.push({ ...entry, theirs });
  }
  return { stale, rest };
}

/** The candidates of an image that wait for an answer, in the order in which they were refused. */
export function staleCandidates(stale: readonly StaleDecision[], imageId: number): StaleCandidate[] {
  const found = new Map<number, StaleDecision[]>();
  for (const entry of stale) {
    if (entry.imageId !== imageId) continue;
    const { segment_id } = entry.decision;
    found.set(segment_id, [...(found.get(segment_id) ?? []), entry]);
  }
  return [...found].flatMap(([segmentId, decisions]) => {
    const last = decisions.at(-1);
    return last === undefined
      ? []
      : [{ segmentId, mine: last.decision.verdict, theirs: last.theirs, decisions }];
  });
}

/** The same decisions once more, by someone who knows the other verdict now. */
export function seenByNow(stale: readonly StaleDecision[]): OutboxEntry[] {
  return stale.map(({ imageId, decision, seen, theirs }) => ({
    imageId,
    decision,
    seen: Math.max(seen ?? 0, theirs.decision_id),
  }));
}

/** What others said that an edit would have overruled unseen: "Jon rejected this line meanwhile."; null: no such thing. */
export function describeStaleEdit(problem: Problem): string | null {
  const told = listedIn(problem).map(
    ({ theirs: { person, verdict } }) => `${person ?? "Someone"} ${SAID[verdict]}`,
  );
  if (told.length === 0) return null;
  const said = [...new Set(told)].join(" and ");
  return `${said} meanwhile. Nothing was changed; do it again if it is to be so all the same.`;
}

const SAID: Readonly<Record<Verdict, string>> = {
  keep: "kept this line",
  reject: "rejected this line",
  ambiguous: "called this line ambiguous",
  undecided: "took the verdict on this line back",
};

function conflictsOf(problem: Problem): Map<string, TheirVerdict> {
  return new Map(listedIn(problem).map(({ client_id, theirs }) => [client_id, theirs]));
}

function listedIn({ code, details }: Problem): readonly Conflict[] {
  return code === STALE_VERDICT ? ((details?.conflicts as Conflict[] | undefined) ?? []) : [];
}
