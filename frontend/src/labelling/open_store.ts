/** A store for fetched annotations, with whatever is still in the outbox on top; `catchUp` brings the history. */

import type { NewDecision, Verdict } from "../api/types";
import type { Annotations } from "./annotations";
import { asRecorded, rebuildHistory } from "./history";
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
  const verdicts = new Map<number, Verdict>(candidates.map(({ id, verdict }) => [id, verdict]));
  const recorded = asRecorded(pending, (id) => verdicts.get(id) ?? "undecided");
  for (const { segment_id, verdict } of pending) verdicts.set(segment_id, verdict);
  return new LabelStore({
    candidates,
    verdicts: candidates.map(({ id }) => verdicts.get(id) ?? "undecided"),
    history: rebuildHistory(recorded, (id) => verdicts.has(id)),
    imageHeight,
    order,
    shown,
    stopwatch,
    newId,
    record,
  });
}
