/** Lines as coarse as a zoom allows, each made when it is first drawn there. */

import type { Polylines } from "./decode";
import { at } from "./geometry";
import { simplifyLine } from "./simplify";

/** What simplification may move a line by, in screen px. */
const SCREEN_TOLERANCE = 0.35;
/** Who zooms to and fro finds its lines made; who went through all zooms leaves no more behind than this. */
const MOST_LEVELS = 6;

type Level = (Float32Array | undefined)[];

/** The vertices x0, y0, x1, y1, ... of a polyline for a scale (screen px per image px). */
export type LineAtScale = (index: number, scale: number) => Float32Array;

export function makeDetailLevels({ coordinates, offsets }: Polylines): LineAtScale {
  const levels = new Map<number, Level>();

  function linesOf(level: number): Level {
    const known = levels.get(level);
    if (known !== undefined) return known;
    const made: Level = [];
    levels.set(level, made);
    const oldest = levels.keys().next().value;
    if (levels.size > MOST_LEVELS && oldest !== undefined) levels.delete(oldest);
    return made;
  }

  return (index, scale) => {
    // Two levels per octave; the level's largest scale decides, so that no zoom is drawn too coarsely.
    const level = Math.ceil(2 * Math.log2(Math.max(scale, 1e-3))) / 2;
    const lines = linesOf(level);
    let line = lines[index];
    if (line === undefined) {
      const [first, end] = [at(offsets, index), at(offsets, index + 1)];
      line = simplifyLine(coordinates, first, end, SCREEN_TOLERANCE / 2 ** level);
      lines[index] = line;
    }
    return line;
  };
}
