/** The order in which candidates are visited. */

import type { SegmentFacts } from "../api/types";

export const REVIEW_ORDERS = ["position", "score", "length", "value", "lens"] as const;
export type ReviewOrder = (typeof REVIEW_ORDERS)[number];

export const REVIEW_ORDER_NAMES: Readonly<Record<ReviewOrder, { short: string; whole: string }>> = {
  position: { short: "Place", whole: "Left to right, top to bottom" },
  score: { short: "Score", whole: "Best score first" },
  length: { short: "Length", whole: "Longest first" },
  value: { short: "Value", whole: "What is most worth a look first: uncertain and long" },
  lens: { short: "Lens", whole: "What tells most of the lens first" },
};

/** What a look at a candidate is worth; null where nobody knows. */
export type Worth = { readonly value: number; readonly lens: number } | null;

/** A row of reading is at most the image's height over this; its lines are visited from left to right. */
const ROWS = 6;

/** The order that follows on another; after the last comes the first. */
export function orderAfter(order: ReviewOrder): ReviewOrder {
  return REVIEW_ORDERS[(REVIEW_ORDERS.indexOf(order) + 1) % REVIEW_ORDERS.length] ?? "position";
}

/**
 * Indices of the candidates in the order of review.
 *
 * @param worth By candidate index; as long as it isn't known, the orders by it are the one by place.
 */
export function reviewSequence(
  candidates: readonly SegmentFacts[],
  order: ReviewOrder,
  imageHeight: number,
  worth: readonly Worth[] = [],
): number[] {
  const keys = KEYS[order](candidates, imageHeight, worth);
  return candidates
    .map((_, index) => index)
    .sort((a, b) => compare(keys[a] as number[], keys[b] as number[]) || a - b);
}

type SortKeys = (
  candidates: readonly SegmentFacts[],
  imageHeight: number,
  worth: readonly Worth[],
) => number[][];

const byPlace: SortKeys = (candidates, imageHeight) => {
  const middles = candidates.map(({ box: [, y0, , y1] }) => (y0 + y1) / 2);
  const rows = readingRows(middles, Math.max(imageHeight, 1) / ROWS);
  return candidates.map(({ box: [x0, , x1] }, index) => [
    rows[index] as number,
    x0 + x1,
    middles[index] as number,
  ]);
};

/** What nobody knows the worth of comes last; equals in the order of their places. */
function byWorth(kind: "value" | "lens"): SortKeys {
  return (candidates, imageHeight, worth) =>
    byPlace(candidates, imageHeight, worth).map((place, index) => [-(worth[index]?.[kind] ?? -1), ...place]);
}

const KEYS: Readonly<Record<ReviewOrder, SortKeys>> = {
  position: byPlace,
  score: (candidates) => candidates.map(({ score, straight }) => [-(score ?? 0), straight === false ? 1 : 0]),
  length: (candidates) => candidates.map(({ length }) => [-length]),
  value: byWorth("value"),
  lens: byWorth("lens"),
};

/**
 * The row that each height belongs to.
 *
 * Rows are cut where the lines leave a gap, not at fixed heights: a row of windows whose middles differ by a
 * pixel would else be torn apart.
 *
 * @param tallest Height of a row at most; a cut is looked for in the lower half of that.
 */
export function readingRows(heights: readonly number[], tallest: number): number[] {
  const sorted = [...heights].sort((a, b) => a - b);
  const starts: number[] = [];
  for (let first = 0; first < sorted.length; first = endOfRow(sorted, first, tallest)) {
    starts.push(sorted[first] as number);
  }
  return heights.map((height) => starts.findLastIndex((start) => start <= height));
}

function endOfRow(sorted: readonly number[], first: number, tallest: number): number {
  const top = sorted[first] as number;
  let end = sorted.length;
  let widest = 0;
  for (let next = first + 1; next < sorted.length; next++) {
    const height = sorted[next] as number;
    const gap = height - (sorted[next - 1] as number);
    if (height - top >= tallest / 2 && gap > widest) {
      widest = gap;
      end = next;
    }
    // Without a line beyond it, what is left is the last row.
    if (height - top > tallest) return end;
  }
  return sorted.length;
}

function compare(a: readonly number[], b: readonly number[]): number {
  for (let i = 0; i < a.length; i++) {
    const difference = (a[i] as number) - (b[i] as number);
    if (difference !== 0) return difference;
  }
  return 0;
}

/**
 * The next candidate in a cyclic sequence that is accepted; null where none is.
 *
 * @param from The candidate to start after; null starts at the sequence's beginning (or end, backwards).
 */
export function nextInSequence(
  sequence: readonly number[],
  from: number | null,
  direction: 1 | -1,
  accept: (index: number) => boolean,
): number | null {
  const count = sequence.length;
  const found = from === null ? -1 : sequence.indexOf(from);
  const start = found >= 0 ? found : direction === 1 ? -1 : count;
  for (let step = 1; step <= count; step++) {
    const index = sequence[(((start + direction * step) % count) + count) % count] as number;
    if (index !== from && accept(index)) return index;
  }
  return null;
}
