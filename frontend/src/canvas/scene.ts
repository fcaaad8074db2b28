/** The lines of one image, ready to be drawn and pointed at. Never changes: verdicts live elsewhere. */

import type { Polylines } from "./decode";
import { at, type Box, boxOf, distanceToPolyline } from "./geometry";
import { type SimplifiedPolylines, simplify, vertexTolerances } from "./simplify";
import { makeSpatialIndex, type SpatialIndex } from "./spatial_index";

/** What simplification may move a line by, in screen px. */
const SCREEN_TOLERANCE = 0.35;

export interface Hit {
  /** Index of the polyline. */
  readonly index: number;
  /** Distance in image px. */
  readonly distance: number;
}

export interface Scene {
  readonly count: number;
  readonly boxes: readonly Box[];
  readonly polylines: Polylines;
  readonly places: SpatialIndex;
  /** The polylines as coarse as a scale (screen px per image px) allows. */
  atScale(scale: number): SimplifiedPolylines;
  /** Polylines within a radius (image px) of a position, nearest first. */
  near(x: number, y: number, radius: number, accept: (index: number) => boolean): Hit[];
}

export function makeScene(polylines: Polylines): Scene {
  const { coordinates, offsets } = polylines;
  const count = offsets.length - 1;
  const boxes = Array.from({ length: count }, (_, s) =>
    boxOf(coordinates, at(offsets, s), at(offsets, s + 1)),
  );
  const places = makeSpatialIndex(boxes);
  const tolerances = vertexTolerances(coordinates, offsets);
  const levels = new Map<number, SimplifiedPolylines>();

  function atScale(scale: number): SimplifiedPolylines {
    // Two levels per octave; the level's largest scale decides, so that no zoom is drawn too coarsely.
    const level = Math.ceil(2 * Math.log2(Math.max(scale, 1e-3))) / 2;
    let simplified = levels.get(level);
    if (simplified === undefined) {
      simplified = simplify(coordinates, offsets, tolerances, SCREEN_TOLERANCE / 2 ** level);
      levels.set(level, simplified);
    }
    return simplified;
  }

  function near(x: number, y: number, radius: number, accept: (index: number) => boolean): Hit[] {
    const around = { minX: x - radius, minY: y - radius, maxX: x + radius, maxY: y + radius };
    return places
      .touching(around, accept)
      .map((index) => ({
        index,
        distance: distanceToPolyline(coordinates, at(offsets, index), at(offsets, index + 1), x, y),
      }))
      .filter((hit) => hit.distance <= radius)
      .sort((a, b) => a.distance - b.distance || a.index - b.index);
  }

  return { count, boxes, polylines, places, atScale, near };
}

export const EMPTY_SCENE: Scene = makeScene({
  revision: 0,
  ids: new Uint32Array(0),
  offsets: new Uint32Array(1),
  coordinates: new Float32Array(0),
});
