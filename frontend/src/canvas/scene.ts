/** The lines of one image, ready to be drawn and pointed at. Never changes: verdicts live elsewhere. */

import type { Polylines } from "./decode";
import { type LineAtScale, makeDetailLevels } from "./detail_levels";
import {
  at,
  type Box,
  boxAround,
  boxContains,
  boxOf,
  distanceToPolyline,
  growBox,
  type Point,
} from "./geometry";
import { makeSpatialIndex, type SpatialIndex } from "./spatial_index";
import { shareInside, strokeTouches } from "./touching";

/** What of a line has to lie inside a lasso. */
const HALF = 0.5;

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
  /** A polyline as coarse as a scale allows. */
  readonly line: LineAtScale;
  /** Polylines within a radius (image px) of a position, nearest first. */
  near(x: number, y: number, radius: number, accept: (index: number) => boolean): Hit[];
  /** Polylines that a straight stroke with a radius (image px) touches. */
  along(from: Point, to: Point, radius: number, accept: (index: number) => boolean): number[];
  /** Polylines of which at least one half lies in a box. */
  inBox(box: Box, accept: (index: number) => boolean): number[];
  /** Polylines of which a closed polygon goes around at least one half. */
  within(polygon: readonly Point[], accept: (index: number) => boolean): number[];
}

export function makeScene(polylines: Polylines): Scene {
  const { coordinates, offsets } = polylines;
  const count = offsets.length - 1;
  const boxes = Array.from({ length: count }, (_, s) =>
    boxOf(coordinates, at(offsets, s), at(offsets, s + 1)),
  );
  const places = makeSpatialIndex(boxes);
  const line = makeDetailLevels(polylines);

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

  function along(from: Point, to: Point, radius: number, accept: (index: number) => boolean): number[] {
    return places
      .touching(growBox(boxAround([from, to]), radius), accept)
      .filter((index) =>
        strokeTouches(coordinates, at(offsets, index), at(offsets, index + 1), from, to, radius),
      );
  }

  function within(polygon: readonly Point[], accept: (index: number) => boolean): number[] {
    if (polygon.length < 3) return [];
    return places
      .touching(boxAround(polygon), accept)
      .filter(
        (index) => shareInside(coordinates, at(offsets, index), at(offsets, index + 1), polygon) >= HALF,
      );
  }

  function inBox(box: Box, accept: (index: number) => boolean): number[] {
    const polygon = cornersOf(box);
    return places.touching(box, accept).filter((index) => {
      // Most lie in it whole, which needs no look at their points.
      if (boxContains(box, boxes[index] as Box)) return true;
      return shareInside(coordinates, at(offsets, index), at(offsets, index + 1), polygon) >= HALF;
    });
  }

  return { count, boxes, polylines, places, line, near, along, inBox, within };
}

function cornersOf({ minX, minY, maxX, maxY }: Box): Point[] {
  return [
    { x: minX, y: minY },
    { x: maxX, y: minY },
    { x: maxX, y: maxY },
    { x: minX, y: maxY },
  ];
}

export const EMPTY_SCENE: Scene = makeScene({
  revision: 0,
  ids: new Uint32Array(0),
  offsets: new Uint32Array(1),
  coordinates: new Float32Array(0),
});
