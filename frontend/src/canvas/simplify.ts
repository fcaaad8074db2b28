/**
 * Polyline simplification after Douglas and Peucker, "Algorithms for the reduction of the number of points
 * required to represent a digitized line or its caricature", Cartographica 10 (1973).
 *
 * The recursion runs once per image: each vertex gets the tolerance (in px) at which it disappears. A zoom
 * level is then one linear pass over these numbers. Only what is drawn is simplified, never what is stored.
 */

import { at, squaredDistanceToPiece } from "./geometry";

/** A vertex that is nearer to its chord is never seen, at no zoom (px); straight lines would be gone through point by point. */
const INVISIBLE = 1e-3;

/** The tolerance in px at which each vertex disappears; the ends of a polyline never do (infinity). */
export function vertexTolerances(coordinates: Float32Array, offsets: Uint32Array): Float32Array {
  const tolerances = new Float32Array(coordinates.length / 2);
  for (let s = 0; s + 1 < offsets.length; s++) {
    rank(coordinates, at(offsets, s), at(offsets, s + 1) - 1, tolerances);
  }
  return tolerances;
}

function rank(coordinates: Float32Array, first: number, last: number, tolerances: Float32Array): void {
  tolerances[first] = Number.POSITIVE_INFINITY;
  tolerances[last] = Number.POSITIVE_INFINITY;
  const stack = [first, last, Number.POSITIVE_INFINITY];
  while (stack.length > 0) {
    const limit = stack.pop() as number;
    const end = stack.pop() as number;
    const start = stack.pop() as number;
    if (end - start < 2) continue;
    const { index, distance } = farthest(coordinates, start, end);
    if (distance < INVISIBLE) continue;
    // A vertex never outlives the one that split its piece, so that each level contains the coarser ones.
    const tolerance = Math.min(distance, limit);
    tolerances[index] = tolerance;
    stack.push(start, index, tolerance, index, end, tolerance);
  }
}

function farthest(
  coordinates: Float32Array,
  start: number,
  end: number,
): { index: number; distance: number } {
  const ax = at(coordinates, 2 * start);
  const ay = at(coordinates, 2 * start + 1);
  const bx = at(coordinates, 2 * end);
  const by = at(coordinates, 2 * end + 1);
  let index = start + 1;
  let most = -1;
  for (let i = start + 1; i < end; i++) {
    const square = squaredDistanceToPiece(at(coordinates, 2 * i), at(coordinates, 2 * i + 1), ax, ay, bx, by);
    if (square > most) {
      most = square;
      index = i;
    }
  }
  return { index, distance: Math.sqrt(most) };
}

export interface SimplifiedPolylines {
  readonly offsets: Uint32Array;
  readonly coordinates: Float32Array;
}

/** The polylines without the vertices that disappear at a tolerance (px); deviates by at most the tolerance. */
export function simplify(
  coordinates: Float32Array,
  offsets: Uint32Array,
  tolerances: Float32Array,
  tolerance: number,
): SimplifiedPolylines {
  let count = 0;
  for (const value of tolerances) if (value > tolerance) count++;
  const kept = new Float32Array(2 * count);
  const keptOffsets = new Uint32Array(offsets.length);
  let next = 0;
  for (let s = 0; s + 1 < offsets.length; s++) {
    const end = at(offsets, s + 1);
    for (let i = at(offsets, s); i < end; i++) {
      if (at(tolerances, i) <= tolerance) continue;
      kept[2 * next] = at(coordinates, 2 * i);
      kept[2 * next + 1] = at(coordinates, 2 * i + 1);
      next++;
    }
    keptOffsets[s + 1] = next;
  }
  return { offsets: keptOffsets, coordinates: kept };
}
