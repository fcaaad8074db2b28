/** A store for fetched annotations, with whatever is still in the outbox on top; `catchUp` brings the history. */

import type { NewDecision } from "../api/types";
import type { Annotations } from "./annotations";
import { asRecorded, type Judgement, rebuildHistory, UNDECIDED } from "./history";
import type { Shown } from "./label_state";
import { LabelStore } from "./label_store";
import type { ReviewOrder } from "./order";
import type { Stopwatch } from "./stopwatch";

interface Surroundings {
  /** Decisions of this image that the server hasn't acknowledged. */
  pending: readonly NewDecision[];
  order: ReviewOrder;
  shown: Shown;
  stopwatch: Stopwatch;
  newId: () => string;
  record: (decisions: NewDecision[]) => void;
}

export function openLabelStore(annotations: Annotations, surroundings: Surroundings): LabelStore {
  const { candidates, imageHeight } = annotations;
  const { pending, order, shown, stopwatch, newId, record } = surroundings;
  const judgements = new Map<number, Judgement>(
    candidates.map(({ id, verdict, reason }) => [id, { verdict, reason }]),
  );
  const recorded = asRecorded(pending, (id) => judgements.get(id) ?? UNDECIDED);
  for (const { segment_id, verdict, reason = null } of pending) {
    judgements.set(segment_id, { verdict, reason });
  }
  return new LabelStore({
    candidates,
    verdicts: candidates.map(({ id }) => judgements.get(id)?.verdict ?? "undecided"),
    reasons: candidates.map(({ id }) => judgements.get(id)?.reason ?? null),
    history: rebuildHistory(recorded, (id) => judgements.has(id)),
    imageHeight,
    order,
    shown,
    stopwatch,
    newId,
    record,
  });
}
