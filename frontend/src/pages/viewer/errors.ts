/** The order in which the errors of an image are visited. */

import { readingRows } from "../../labelling/order";
import { isError } from "./layers";
import type { MatchedImage, MatchedLine } from "./matched_image";

export const ERROR_ORDERS = ["worst", "near", "score", "place"] as const;
export type ErrorOrder = (typeof ERROR_ORDERS)[number];
export const DEFAULT_ORDER: ErrorOrder = "worst";

export const ERROR_ORDER_NAMES: Readonly<Record<ErrorOrder, { short: string; whole: string }>> = {
  worst: { short: "Worst", whole: "Most px without a counterpart first: length × (1 − LIoU)" },
  near: { short: "Nearly", whole: "Nearly right first: the highest LIoU" },
  score: { short: "Score", whole: "The surest false positives first, then the misses" },
  place: { short: "Place", whole: "Left to right, top to bottom" },
};

/** A row of reading is at most the image's height over this. */
const ROWS = 6;

/** Indices in the scene of false positives and misses. */
export function errorSequence(image: MatchedImage, order: ErrorOrder): number[] {
  const errors = image.lines.filter(({ layer }) => isError(layer));
  const keys = sortKeys(image, errors, order);
  return errors
    .map((error, place) => ({ error, key: keys[place] as readonly number[] }))
    .sort((a, b) => compare(a.key, b.key) || b.error.length - a.error.length || a.error.index - b.error.index)
    .map(({ error }) => error.index);
}

/** Length that no line of the other kind accounts for, px. */
export function severity({ length, liou }: MatchedLine): number {
  return length * (1 - (liou ?? 0));
}

/** What to sort by, smallest first. */
function sortKeys(image: MatchedImage, errors: readonly MatchedLine[], order: ErrorOrder): number[][] {
  switch (order) {
    case "worst":
      return errors.map((error) => [-severity(error)]);
    case "near":
      return errors.map(({ liou }) => [-(liou ?? 0)]);
    case "score":
      return errors.map(({ layer, score }) => [layer === "fp" ? 0 : 1, -(score ?? 0)]);
    case "place":
      return placeKeys(image, errors);
  }
}

function placeKeys({ scene, detail }: MatchedImage, errors: readonly MatchedLine[]): number[][] {
  const boxes = errors.flatMap(({ index }) => scene.boxes[index] ?? []);
  const middles = boxes.map(({ minY, maxY }) => (minY + maxY) / 2);
  const rows = readingRows(middles, Math.max(detail.height, 1) / ROWS);
  return boxes.map(({ minX, maxX }, place) => [rows[place] as number, minX + maxX]);
}

function compare(a: readonly number[], b: readonly number[]): number {
  for (let i = 0; i < a.length; i++) {
    const difference = (a[i] as number) - (b[i] as number);
    if (difference !== 0) return difference;
  }
  return 0;
}
