/** Curves of equal F1 in the plane of recall (x) and precision (y). */

export type Point = readonly [x: number, y: number];

/**
 * The curve of one F1 within a window, from its left to its right end; empty where it doesn't cross it.
 *
 * From F1 = 2PR / (P + R): P = F1 R / (2R - F1).
 *
 * @param recall the window's recalls.
 * @param precision the window's precisions.
 */
export function isoF1(
  f1: number,
  recall: readonly [number, number],
  precision: readonly [number, number],
  pieces = 48,
): Point[] {
  const recallAt = (p: number) => (f1 * p) / (2 * p - f1);
  // The curve falls from left to right: where it enters at the top and leaves at the bottom.
  const entry = 2 * precision[1] > f1 ? recallAt(precision[1]) : Number.POSITIVE_INFINITY;
  const exit = 2 * precision[0] > f1 ? recallAt(precision[0]) : Number.POSITIVE_INFINITY;
  const start = Math.max(recall[0], entry);
  const end = Math.min(recall[1], exit);
  if (!(end > start)) return [];
  return Array.from({ length: pieces + 1 }, (_, index) => {
    const r = start + ((end - start) * index) / pieces;
    return [r, (f1 * r) / (2 * r - f1)] as const;
  });
}

/** The values of F1 whose curves are drawn: every tenth that the window holds, every twentieth where it is small. */
export function isoF1Levels(
  recall: readonly [number, number],
  precision: readonly [number, number],
): number[] {
  const step = Math.max(recall[1] - recall[0], precision[1] - precision[0]) <= 0.35 ? 0.05 : 0.1;
  const low = harmonicMean(recall[0], precision[0]);
  const high = harmonicMean(recall[1], precision[1]);
  const first = Math.floor(low / step + 1e-9) + 1;
  const last = Math.ceil(high / step - 1e-9) - 1;
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) =>
    Number(((first + index) * step).toFixed(10)),
  );
}

export function harmonicMean(a: number, b: number): number {
  return a + b === 0 ? 0 : (2 * a * b) / (a + b);
}
