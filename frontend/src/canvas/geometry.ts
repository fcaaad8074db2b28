/**
 * Plane geometry on packed coordinates.
 *
 * A coordinate array holds x0, y0, x1, y1, ... in image px: x right, y down, the centre of the top left
 * pixel at (0, 0).
 */

export interface Point {
  readonly x: number;
  readonly y: number;
}

export interface Box {
  readonly minX: number;
  readonly minY: number;
  readonly maxX: number;
  readonly maxY: number;
}

/** Squared distance of (px, py) to the line piece from (ax, ay) to (bx, by). */
export function squaredDistanceToPiece(
  px: number,
  py: number,
  ax: number,
  ay: number,
  bx: number,
  by: number,
): number {
  const dx = bx - ax;
  const dy = by - ay;
  const square = dx * dx + dy * dy;
  const along = square === 0 ? 0 : ((px - ax) * dx + (py - ay) * dy) / square;
  const t = clamp(along, 0, 1);
  const ex = px - (ax + t * dx);
  const ey = py - (ay + t * dy);
  return ex * ex + ey * ey;
}

/** Whether any part of a polyline x0, y0, x1, y1, ... lies in a box. */
export function polylineReaches(line: Float32Array, { minX, minY, maxX, maxY }: Box): boolean {
  const centreX = (minX + maxX) / 2;
  const centreY = (minY + maxY) / 2;
  const halfX = (maxX - minX) / 2;
  const halfY = (maxY - minY) / 2;
  for (let i = 0; i < line.length; i += 2) {
    const next = Math.min(i + 2, line.length - 2);
    const ax = at(line, i) - centreX;
    const ay = at(line, i + 1) - centreY;
    const bx = at(line, next) - centreX;
    const by = at(line, next + 1) - centreY;
    if (Math.min(ax, bx) > halfX || Math.max(ax, bx) < -halfX) continue;
    if (Math.min(ay, by) > halfY || Math.max(ay, by) < -halfY) continue;
    // Neither axis separates them; the piece's own normal may (separating axis theorem).
    const nx = ay - by;
    const ny = bx - ax;
    if (Math.abs(nx * ax + ny * ay) <= Math.abs(nx) * halfX + Math.abs(ny) * halfY) return true;
  }
  return false;
}

/** Distance in px of a position to the polyline of the points first..end - 1. */
export function distanceToPolyline(
  coordinates: Float32Array,
  first: number,
  end: number,
  x: number,
  y: number,
): number {
  if (end - first === 1) {
    return Math.hypot(x - at(coordinates, 2 * first), y - at(coordinates, 2 * first + 1));
  }
  let best = Number.POSITIVE_INFINITY;
  for (let i = first; i + 1 < end; i++) {
    const square = squaredDistanceToPiece(
      x,
      y,
      at(coordinates, 2 * i),
      at(coordinates, 2 * i + 1),
      at(coordinates, 2 * i + 2),
      at(coordinates, 2 * i + 3),
    );
    if (square < best) best = square;
  }
  return Math.sqrt(best);
}

/** The smallest box around the points first..end - 1. */
export function boxOf(coordinates: ArrayLike<number>, first: number, end: number): Box {
  let minX = Number.POSITIVE_INFINITY;
  let minY = Number.POSITIVE_INFINITY;
  let maxX = Number.NEGATIVE_INFINITY;
  let maxY = Number.NEGATIVE_INFINITY;
  for (let i = first; i < end; i++) {
    const x = at(coordinates, 2 * i);
    const y = at(coordinates, 2 * i + 1);
    if (x < minX) minX = x;
    if (x > maxX) maxX = x;
    if (y < minY) minY = y;
    if (y > maxY) maxY = y;
  }
  return { minX, minY, maxX, maxY };
}

/** The smallest box around some positions. */
export function boxAround(positions: readonly Point[]): Box {
  return boxOf(
    positions.flatMap(({ x, y }) => [x, y]),
    0,
    positions.length,
  );
}

export function boxCentre(box: Box): Point {
  return { x: (box.minX + box.maxX) / 2, y: (box.minY + box.maxY) / 2 };
}

/** The longer side of a box. */
export function boxExtent(box: Box): number {
  return Math.max(box.maxX - box.minX, box.maxY - box.minY);
}

export function growBox(box: Box, margin: number): Box {
  return {
    minX: box.minX - margin,
    minY: box.minY - margin,
    maxX: box.maxX + margin,
    maxY: box.maxY + margin,
  };
}

export function boxContains(outer: Box, inner: Box): boolean {
  return (
    inner.minX >= outer.minX &&
    inner.minY >= outer.minY &&
    inner.maxX <= outer.maxX &&
    inner.maxY <= outer.maxY
  );
}

export function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

/** An array element whose index the caller has bounded. */
export function at(values: ArrayLike<number>, index: number): number {
  return values[index] as number;
}
