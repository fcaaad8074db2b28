/** What a stroke touches and what a lasso goes around; image px, packed coordinates. */

import { at, clamp, type Point, squaredDistanceToPiece } from "./geometry";

/**
 * Whether any part of the polyline of the points first..end - 1 comes within a radius of the straight stroke from
 * one position to another. A stroke of no length is a disc; a polyline of one point is that point.
 */
export function strokeTouches(
  coordinates: Float32Array,
  first: number,
  end: number,
  from: Point,
  to: Point,
  radius: number,
): boolean {
  const square = radius * radius;
  const { x: sx, y: sy } = from;
  const { x: ex, y: ey } = to;
  const minX = Math.min(sx, ex) - radius;
  const maxX = Math.max(sx, ex) + radius;
  const minY = Math.min(sy, ey) - radius;
  const maxY = Math.max(sy, ey) + radius;
  for (let i = first; i < Math.max(end - 1, first + 1); i++) {
    const next = Math.min(i + 1, end - 1);
    const ax = at(coordinates, 2 * i);
    const ay = at(coordinates, 2 * i + 1);
    const bx = at(coordinates, 2 * next);
    const by = at(coordinates, 2 * next + 1);
    if ((ax < minX && bx < minX) || (ax > maxX && bx > maxX)) continue;
    if ((ay < minY && by < minY) || (ay > maxY && by > maxY)) continue;
    if (squaredGap(sx, sy, ex, ey, ax, ay, bx, by) <= square) return true;
  }
  return false;
}

/** Squared distance between the line pieces s-e and a-b: 0 where they cross, else from an end of one to the other. */
export function squaredGap(
  sx: number,
  sy: number,
  ex: number,
  ey: number,
  ax: number,
  ay: number,
  bx: number,
  by: number,
): number {
  if (cross(sx, sy, ex, ey, ax, ay, bx, by)) return 0;
  return Math.min(
    squaredDistanceToPiece(sx, sy, ax, ay, bx, by),
    squaredDistanceToPiece(ex, ey, ax, ay, bx, by),
    squaredDistanceToPiece(ax, ay, sx, sy, ex, ey),
    squaredDistanceToPiece(bx, by, sx, sy, ex, ey),
  );
}

/** Whether each piece's ends lie on both sides of the other; pieces that only touch have an end at distance 0. */
function cross(
  sx: number,
  sy: number,
  ex: number,
  ey: number,
  ax: number,
  ay: number,
  bx: number,
  by: number,
): boolean {
  const a = (ex - sx) * (ay - sy) - (ey - sy) * (ax - sx);
  const b = (ex - sx) * (by - sy) - (ey - sy) * (bx - sx);
  const s = (bx - ax) * (sy - ay) - (by - ay) * (sx - ax);
  const e = (bx - ax) * (ey - ay) - (by - ay) * (ex - ax);
  return a * b < 0 && s * e < 0;
}

/** Whether a position lies inside a closed polygon; where it crosses itself, by the even-odd rule. */
export function polygonContains(polygon: readonly Point[], x: number, y: number): boolean {
  let inside = false;
  let before = polygon.at(-1);
  for (const corner of polygon) {
    if (before !== undefined && corner.y > y !== before.y > y) {
      const crossing = corner.x + ((y - corner.y) / (before.y - corner.y)) * (before.x - corner.x);
      if (x < crossing) inside = !inside;
    }
    before = corner;
  }
  return inside;
}

/** Places on a line at which is looked whether they lie in a lasso. */
const SAMPLES = 12;

/** The share (0 to 1) of the polyline of the points first..end - 1 that a polygon goes around, by sampling. */
export function shareInside(
  coordinates: Float32Array,
  first: number,
  end: number,
  polygon: readonly Point[],
): number {
  let inside = 0;
  for (let sample = 0; sample < SAMPLES; sample++) {
    // In the middle of equal parts, between the two points there: a line may have no more than its ends.
    const place = first + ((sample + 0.5) / SAMPLES) * (end - 1 - first);
    const i = clamp(Math.floor(place), first, Math.max(first, end - 2));
    const next = Math.min(i + 1, end - 1);
    const part = place - i;
    const x = at(coordinates, 2 * i) * (1 - part) + at(coordinates, 2 * next) * part;
    const y = at(coordinates, 2 * i + 1) * (1 - part) + at(coordinates, 2 * next + 1) * part;
    if (polygonContains(polygon, x, y)) inside++;
  }
  return inside / SAMPLES;
}
