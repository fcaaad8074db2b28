/** Candidates for tests, with only what a test cares about. */

import type { SegmentFacts } from "../api/types";

export function candidate(id: number, facts: Partial<SegmentFacts> = {}): SegmentFacts {
  return {
    id,
    ordinal: id,
    n_points: 10,
    length: 100,
    residual: 0.1,
    score: 0.5,
    straightness: 0.9,
    straight: true,
    verdict: "undecided",
    reason: null,
    origin: "pipeline",
    box: [10 * id, 0, 10 * id + 5, 5],
    ...facts,
  };
}
