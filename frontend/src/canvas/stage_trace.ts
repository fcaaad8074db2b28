/**
 * Where along a candidate its pieces, its gaps and what was added lie.
 *
 * The pieces are told by the ends of arcs, which a lens bends away from their chords; so each is drawn as the
 * part of the candidate's own polyline between them. Positions along a polyline are vertex numbers: 2.5 is
 * the middle between vertex 2 and 3.
 */

import type { StageHistory } from "../api/types";
import type { Polylines } from "./decode";
import { at, clamp, type Point, squaredDistanceToPiece } from "./geometry";

/** A part of the candidate: x0, y0, x1, y1, ... in image px, two points at least. */
export type Stretch = Float32Array;

export interface StageTrace {
  /** Of the candidate in the scene. */
  readonly index: number;
  readonly whole: Stretch;
  /** Without the pieces that were cut off entirely. */
  readonly pieces: readonly Stretch[];
  /** One for each join of the history. */
  readonly gaps: readonly Stretch[];
  /** Before the first piece and after the last, where the edge was followed on. */
  readonly added: readonly Stretch[];
}

/** Shorter parts can't be seen and have no direction (px). */
const LEAST_LENGTH = 0.05;

export function traceStages(polylines: Polylines, index: number, history: StageHistory): StageTrace {
  const first = at(polylines.offsets, index);
  const end = at(polylines.offsets, index + 1);
  const line = polylines.coordinates.subarray(2 * first, 2 * end);
  const last = end - first - 1;
  const ends = history.pieces.map(
    ({ start, end }) => [positionOf(line, start), positionOf(line, end)] as const,
  );
  const spans = ends.map(([from, to]) => stretch(line, from, to));
  const firstPiece = ends[0]?.[0] ?? 0;
  const lastPiece = ends.at(-1)?.[1] ?? last;
  const added: Stretch[] = [];
  if (history.extended[0] > 0) added.push(stretch(line, 0, firstPiece));
  if (history.extended[1] > 0) added.push(stretch(line, lastPiece, last));
  return {
    index,
    whole: line,
    pieces: spans.filter(isSeen),
    gaps: history.joins.map(({ start, end }) =>
      stretch(line, positionOf(line, start), positionOf(line, end)),
    ),
    added: added.filter(isSeen),
  };
}

/** The middle of a stretch, halfway between its ends. */
export function middleOf(part: Stretch): Point {
  const end = part.length - 2;
  return { x: (at(part, 0) + at(part, end)) / 2, y: (at(part, 1) + at(part, end + 1)) / 2 };
}

/** The position on a polyline that is nearest to a point. */
function positionOf(line: Float32Array, [x, y]: readonly [number, number]): number {
  let best = 0;
  let least = Number.POSITIVE_INFINITY;
  for (let i = 0; i + 3 < line.length; i += 2) {
    const [ax, ay, bx, by] = [at(line, i), at(line, i + 1), at(line, i + 2), at(line, i + 3)];
    const square = squaredDistanceToPiece(x, y, ax, ay, bx, by);
    if (square >= least) continue;
    least = square;
    const [dx, dy] = [bx - ax, by - ay];
    const length = dx * dx + dy * dy;
    best = i / 2 + (length === 0 ? 0 : clamp(((x - ax) * dx + (y - ay) * dy) / length, 0, 1));
  }
  return best;
}

/** The part of a polyline between two positions, in its own direction. */
function stretch(line: Float32Array, one: number, other: number): Stretch {
  const [from, to] = one <= other ? [one, other] : [other, one];
  const points: number[] = [...pointAt(line, from)];
  for (let vertex = Math.floor(from) + 1; vertex < to; vertex++) {
    points.push(at(line, 2 * vertex), at(line, 2 * vertex + 1));
  }
  points.push(...pointAt(line, to));
  return Float32Array.from(points);
}

function pointAt(line: Float32Array, position: number): [number, number] {
  const vertex = Math.min(Math.floor(position), line.length / 2 - 1);
  const next = Math.min(vertex + 1, line.length / 2 - 1);
  const share = position - vertex;
  return [
    at(line, 2 * vertex) * (1 - share) + at(line, 2 * next) * share,
    at(line, 2 * vertex + 1) * (1 - share) + at(line, 2 * next + 1) * share,
  ];
}

function isSeen(part: Stretch): boolean {
  const end = part.length - 2;
  return Math.hypot(at(part, end) - at(part, 0), at(part, end + 1) - at(part, 1)) > LEAST_LENGTH;
}
