/** Candidates by length, score and residual: which lie outside of what is shown, and how many. */

import type { SegmentFacts } from "../api/types";

export const MEASURES = ["length", "score", "residual"] as const;
export type Measure = (typeof MEASURES)[number];

/** What is shown, both ends included; null: without an end on that side. */
export interface Range {
  readonly low: number | null;
  readonly high: number | null;
}

export type Ranges = Readonly<Record<Measure, Range>>;
export type Side = keyof Range;

export const EVERYTHING: Range = { low: null, high: null };
export const NO_RANGES: Ranges = { length: EVERYTHING, score: EVERYTHING, residual: EVERYTHING };

export function isLimited({ low, high }: Range): boolean {
  return low !== null || high !== null;
}

export function areLimited(ranges: Ranges): boolean {
  return MEASURES.some((measure) => isLimited(ranges[measure]));
}

/** Whether a candidate lies beyond one end; what wasn't measured lies beyond none. */
export function isBeyond(candidate: SegmentFacts, measure: Measure, side: Side, range: Range): boolean {
  const value = candidate[measure];
  const end = range[side];
  if (value === null || end === null) return false;
  return side === "low" ? value < end : value > end;
}

export function isInRanges(candidate: SegmentFacts, ranges: Ranges): boolean {
  return MEASURES.every(
    (measure) =>
      !isBeyond(candidate, measure, "low", ranges[measure]) &&
      !isBeyond(candidate, measure, "high", ranges[measure]),
  );
}

/** What a slider can stand at: rising values, of which each step leads to another one. */
export type Stops = readonly number[];

const STEPS: Readonly<Record<Measure, number>> = { length: 1, score: 0.01, residual: 0.01 };
/** Stops of a slider at most. */
const MOST_STOPS = 160;

/** The stops for an image's candidates; null where none of them has this measure. */
export function stopsFor(measure: Measure, candidates: readonly SegmentFacts[]): Stops | null {
  const values = candidates.flatMap((candidate) => candidate[measure] ?? []);
  if (values.length === 0) return null;
  const step = STEPS[measure];
  if (measure === "score") return stopsTo(1, step, (share) => share);
  const largest = values.reduce((most, value) => Math.max(most, value), step);
  // Most candidates are short and nearly straight: the lower values have more room.
  return stopsTo(largest + step, step, (share) => share * share);
}

/** The end that a slider's stop stands for: at its outer end there is none. */
export function endAt(place: number, side: Side, stops: Stops): number | null {
  const outer = side === "low" ? place <= 0 : place >= stops.length - 1;
  return outer ? null : (stops[place] ?? null);
}

/** The slider's stop for an end, the nearest one where another image's candidates had others. */
export function placeOf(end: number | null, side: Side, stops: Stops): number {
  if (end === null) return side === "low" ? 0 : stops.length - 1;
  return stops.reduce(
    (best, stop, place) => (Math.abs(stop - end) < Math.abs((stops[best] ?? 0) - end) ? place : best),
    0,
  );
}

function stopsTo(largest: number, step: number, shape: (share: number) => number): Stops {
  const values = Array.from({ length: MOST_STOPS + 1 }, (_, i) =>
    rounded(largest * shape(i / MOST_STOPS), step),
  );
  return [...new Set(values)];
}

/** Without what floating point adds: 0.29, not 0.29000000000000004. */
function rounded(value: number, step: number): number {
  const decimals = Math.max(0, Math.ceil(-Math.log10(step)));
  return Number((Math.ceil(value / step) * step).toFixed(decimals));
}
