/** The layers of lines on a scored image. */

import type { Outcome } from "../../api/viewer_types";

/** In the order of their keys, from 1 on. "found" are the labels that a true positive lies on. */
export const LAYERS = ["tp", "fp", "fn", "ignored", "found"] as const;
export type Layer = (typeof LAYERS)[number];
export type ShownLayers = Readonly<Record<Layer, boolean>>;

export const LAYER_NAMES: Readonly<Record<Layer, { one: string; many: string; hint: string }>> = {
  tp: { one: "True positive", many: "True positives", hint: "Predictions that are a labelled line" },
  fp: { one: "False positive", many: "False positives", hint: "Predictions that are no labelled line" },
  fn: { one: "Miss", many: "Misses", hint: "Labels that no prediction found (false negatives)" },
  ignored: {
    one: "Ignored line",
    many: "Ignored",
    hint: "Ambiguous or too short labels, and predictions on them: neither right nor wrong",
  },
  found: { one: "Found label", many: "Found labels", hint: "The labels that the true positives lie on" },
};

/**
 * What is neither right nor wrong is shown on request: there may be hundreds of ignored lines, and a found label lies
 * under the prediction that found it.
 */
export const SHOWN_AT_FIRST: ShownLayers = { tp: true, fp: true, fn: true, ignored: false, found: false };

export function layerOf(kind: "label" | "prediction", outcome: Outcome): Layer {
  if (outcome === "hit") return kind === "label" ? "found" : "tp";
  return LAYER_OF[outcome];
}

const LAYER_OF = { false_alarm: "fp", miss: "fn", ignored: "ignored" } as const;

export function isError(layer: Layer): boolean {
  return layer === "fp" || layer === "fn";
}

/** "tp-fn" for an address; null where it is what is shown at first. */
export function writeLayers(shown: ShownLayers): string | null {
  if (LAYERS.every((layer) => shown[layer] === SHOWN_AT_FIRST[layer])) return null;
  return LAYERS.filter((layer) => shown[layer]).join("-") || "none";
}

export function readLayers(text: string | null): ShownLayers {
  if (text === null) return SHOWN_AT_FIRST;
  const names = text.split("-");
  const shown = LAYERS.map((layer) => [layer, names.includes(layer)] as const);
  return Object.fromEntries(shown) as Record<Layer, boolean>;
}
