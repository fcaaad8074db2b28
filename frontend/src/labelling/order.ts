/** The order in which candidates are visited. */

import type { SegmentFacts } from "../api/types";

export const REVIEW_ORDERS = ["position", "score", "length"] as const;
export type ReviewOrder = (typeof REVIEW_ORDERS)[number];

export const REVIEW_ORDER_NAMES: Readonly<Record<ReviewOrder, string>> = {
  position: "Left to right, top to bottom",
  score: "Best score first",
  length: "Longest first",
};

/** Rows that the image is read in; lines of one row are visited from left to right. */
const ROWS = 6;

/** Indices of the candidates in the order of review. */
export function reviewSequence(
  candidates: readonly SegmentFacts[],
  order: ReviewOrder,
  imageHeight: number,
): number[] {
  const key = KEYS[order];
  const keys = candidates.map((candidate) => key(candidate, imageHeight));
  return candidates
    .map((_, index) => index)
    .sort((a, b) => compare(keys[a] as number[], keys[b] as number[]) || a - b);
}

type SortKey = (candidate: SegmentFacts, imageHeight: number) => number[];

const KEYS: Readonly<Record<ReviewOrder, SortKey>> = {
  position: ({ box: [x0, y0, x1, y1] }, height) => {
    const row = Math.floor((ROWS * (y0 + y1)) / (2 * Math.max(height, 1)));
    return [row, x0 + x1, y0 + y1];
  },
  score: ({ score, straight }) => [-(score ?? 0), straight === false ? 1 : 0],
  length: ({ length }) => [-length],
};

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
