/** A small scored image for tests. */

import type { ScoredImageDetail, ScoredLabel, ScoredPrediction } from "../../api/viewer_types";
import type { Polylines } from "../../canvas/decode";
import { type MatchedImage, makeMatchedImage } from "./matched_image";

/** A straight line along a row: from x0 to x1 at height y. */
export type Row = readonly [x0: number, x1: number, y: number];

export interface TestLabel extends Partial<ScoredLabel> {
  row: Row;
}

export interface TestPrediction extends Partial<ScoredPrediction> {
  row: Row;
}

export function detailOf(
  labels: readonly TestLabel[],
  predictions: readonly TestPrediction[],
): ScoredImageDetail {
  return {
    image_id: 1,
    name: "street",
    width: 640,
    height: 480,
    original: "/street/original",
    display: "/street",
    thumbnail: "/street/thumbnail",
    previous: null,
    next: null,
    position: 1,
    total: 1,
    metrics: {},
    truth: labels.map(({ row, ...facts }, index) => ({
      index,
      outcome: "miss",
      length: row[1] - row[0],
      ignored: false,
      error_type: null,
      ...facts,
    })),
    predictions: predictions.map(({ row, ...facts }, index) => ({
      index,
      outcome: "false_alarm",
      score: null,
      length: row[1] - row[0],
      best_label: null,
      liou: 0,
      offset: null,
      angle: null,
      error_type: null,
      rejected_as: null,
      ...facts,
    })),
    review_target: null,
  };
}

/** A point per px of each row. */
export function polylinesOf(rows: readonly Row[]): Polylines {
  const lines = rows.map(([x0, x1, y]) => Array.from({ length: x1 - x0 + 1 }, (_, i) => [x0 + i, y]).flat());
  const offsets = [0];
  for (const line of lines) offsets.push((offsets.at(-1) ?? 0) + line.length / 2);
  return {
    revision: 1,
    ids: Uint32Array.from(rows, (_, index) => index),
    offsets: Uint32Array.from(offsets),
    coordinates: Float32Array.from(lines.flat()),
  };
}

export function matched(labels: readonly TestLabel[], predictions: readonly TestPrediction[]): MatchedImage {
  const rows = [...labels, ...predictions].map(({ row }) => row);
  return makeMatchedImage(detailOf(labels, predictions), polylinesOf(rows));
}
