/** Cells of a grid over an image's frame, and what is drawn on them. All in image px. */

export interface FrameSize {
  readonly width: number;
  readonly height: number;
}

export interface Cell {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/** Where a pixel's area begins when its centre has whole coordinates. */
const HALF_PIXEL = 0.5;

/**
 * Ends of the cells around their middles: halfway between two, and the frame's own ends outside.
 *
 * @param size Extent of the frame.
 */
export function cellEdges(middles: readonly number[], size: number): number[] {
  const between = middles.slice(1).map((middle, index) => ((middles[index] ?? 0) + middle) / 2);
  return [-HALF_PIXEL, ...between, size - HALF_PIXEL];
}

export function cellAt(
  xEdges: readonly number[],
  yEdges: readonly number[],
  column: number,
  row: number,
): Cell {
  const left = xEdges[column] ?? 0;
  const top = yEdges[row] ?? 0;
  return {
    left,
    top,
    width: (xEdges[column + 1] ?? left) - left,
    height: (yEdges[row + 1] ?? top) - top,
  };
}

/** Which cell a position lies in; the outermost ones for what lies outside. */
export function cellIndex(edges: readonly number[], position: number): number {
  const inner = edges.slice(1, -1);
  return inner.filter((edge) => position >= edge).length;
}

/** Factors that people can do in their head: 1, 2, 5, 10... */
export function roundFactor(factor: number): number {
  if (!(factor > 0) || !Number.isFinite(factor)) return 1;
  const power = 10 ** Math.floor(Math.log10(factor));
  const step = [5, 2, 1].find((candidate) => candidate * power <= factor * (1 + 1e-9)) ?? 1;
  return Number((step * power).toPrecision(1));
}
