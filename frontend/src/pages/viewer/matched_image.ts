/** One scored image: its labels and predictions with their points, in the order of the scene. */

import type { RejectReason } from "../../api/types";
import type { ScoredImageDetail, ScoredLabel, ScoredPrediction } from "../../api/viewer_types";
import type { Polylines } from "../../canvas/decode";
import { makeScene, type Scene } from "../../canvas/scene";
import { type Layer, layerOf } from "./layers";

export interface MatchedLine {
  /** In the scene. */
  readonly index: number;
  /** "l3" for label 3, "p12" for prediction 12: what the address calls it. */
  readonly name: string;
  readonly kind: "label" | "prediction";
  readonly layer: Layer;
  readonly length: number;
  readonly score: number | null;
  /** Highest LIoU with a line of the other kind; null where none is near. */
  readonly liou: number | null;
  readonly offset: number | null;
  /** rad */
  readonly angle: number | null;
  readonly errorType: string | null;
  /** Why people rejected the line that a false positive is. */
  readonly rejectedAs: RejectReason | null;
  /** Index in the scene of the line that the LIoU is with. */
  readonly partner: number | null;
}

export interface MatchedImage {
  readonly detail: ScoredImageDetail;
  readonly lines: readonly MatchedLine[];
  readonly scene: Scene;
  readonly counts: Readonly<Record<Layer, number>>;
}

/**
 * @param polylines The labels with the ids 0..L - 1, then the P predictions with the ids L..L + P - 1.
 * @throws Error where the points aren't those of the labels and predictions.
 */
export function makeMatchedImage(detail: ScoredImageDetail, polylines: Polylines): MatchedImage {
  const { truth, predictions } = detail;
  const labels = truth.length;
  if (polylines.ids.length !== labels + predictions.length) {
    throw new Error(
      `The points are of ${polylines.ids.length} lines instead of ${labels + predictions.length}.`,
    );
  }
  const places = new Map(Array.from(polylines.ids, (id, index) => [id, index]));
  const place = (id: number): number => {
    const index = places.get(id);
    if (index === undefined) throw new Error(`Line ${id} has no points.`);
    return index;
  };
  const best = bestPredictions(predictions);
  const lines = [
    ...truth.map((label) => labelLine(label, best.get(label.index), place, labels)),
    ...predictions.map((prediction) => predictionLine(prediction, place, labels)),
  ].sort((a, b) => a.index - b.index);
  return { detail, lines, scene: makeScene(polylines), counts: countLayers(lines) };
}

/** For each label the prediction that comes closest to it. */
function bestPredictions(predictions: readonly ScoredPrediction[]): Map<number, ScoredPrediction> {
  const best = new Map<number, ScoredPrediction>();
  for (const prediction of predictions) {
    const { best_label: label, liou } = prediction;
    if (label === null || liou <= 0) continue;
    // The prediction that counts for a label goes before one that covers it better but doesn't count.
    const known = best.get(label);
    if (known === undefined || rank(prediction) > rank(known)) best.set(label, prediction);
  }
  return best;
}

function rank({ outcome, liou }: ScoredPrediction): number {
  return (outcome === "hit" ? 1 : 0) + liou;
}

function labelLine(
  label: ScoredLabel,
  best: ScoredPrediction | undefined,
  place: (id: number) => number,
  labels: number,
): MatchedLine {
  return {
    index: place(label.index),
    name: `l${label.index}`,
    kind: "label",
    layer: layerOf("label", label.outcome),
    length: label.length,
    score: null,
    liou: best?.liou ?? null,
    offset: best?.offset ?? null,
    angle: best?.angle ?? null,
    errorType: label.error_type,
    rejectedAs: null,
    partner: best === undefined ? null : place(labels + best.index),
  };
}

function predictionLine(
  prediction: ScoredPrediction,
  place: (id: number) => number,
  labels: number,
): MatchedLine {
  const { index, best_label: label, liou } = prediction;
  const near = label !== null && liou > 0;
  return {
    index: place(labels + index),
    name: `p${index}`,
    kind: "prediction",
    layer: layerOf("prediction", prediction.outcome),
    length: prediction.length,
    score: prediction.score,
    liou: near ? liou : null,
    offset: prediction.offset,
    angle: prediction.angle,
    errorType: prediction.error_type,
    rejectedAs: prediction.rejected_as,
    partner: near ? place(label) : null,
  };
}

function countLayers(lines: readonly MatchedLine[]): Record<Layer, number> {
  const counts: Record<Layer, number> = { tp: 0, fp: 0, fn: 0, ignored: 0, found: 0 };
  for (const { layer } of lines) counts[layer]++;
  return counts;
}

export function lineNamed(image: MatchedImage, name: string | null): MatchedLine | null {
  return name === null ? null : (image.lines.find((line) => line.name === name) ?? null);
}
