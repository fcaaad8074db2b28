/** Histories of candidates for tests, with only what a test cares about. */

import type { StageHistory, StageJoin } from "../api/types";

export function stageHistory(facts: Partial<StageHistory> = {}): StageHistory {
  return {
    segment_id: 1,
    image_id: 1,
    run_id: 1,
    pieces: [{ start: [0, 0], end: [100, 0], length: 100 }],
    joins: [],
    extended: [0, 0],
    trimmed: [0, 0],
    score: 0.5,
    score_parts: [],
    intercept: 0,
    ...facts,
  };
}

export function join(from: number, to: number, facts: Partial<StageJoin> = {}): StageJoin {
  return {
    start: [from, 0],
    end: [to, 0],
    gap: to - from,
    cost: 1,
    flipped: false,
    round: "following",
    ...facts,
  };
}
