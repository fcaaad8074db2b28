/** A store for tests: of undecided candidates, with ids that count up. */

import type { NewDecision, SegmentFacts } from "../api/types";
import { NO_HISTORY } from "./history";
import { LabelStore } from "./label_store";
import { Stopwatch } from "./stopwatch";

export function undecidedStore(
  candidates: readonly SegmentFacts[],
  recorded: NewDecision[] = [],
  now: () => number = () => 0,
): LabelStore {
  let id = 0;
  return new LabelStore({
    candidates,
    verdicts: candidates.map(() => "undecided"),
    reasons: candidates.map(() => null),
    history: NO_HISTORY,
    imageHeight: 100,
    order: "position",
    stopwatch: new Stopwatch(now),
    newId: () => `id-${++id}`,
    record: (decisions) => recorded.push(...decisions),
  });
}
