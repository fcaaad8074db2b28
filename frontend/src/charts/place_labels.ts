/** Which points of a chart get their name written beside them, so that no two names lie on each other. */

export interface Labelled {
  id: string;
  x: number;
  y: number;
  text: string;
}

export interface PlacedLabel {
  id: string;
  x: number;
  y: number;
  text: string;
  anchor: "start" | "end";
}

interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

const CHARACTER = 6.4;
const LINE = 14;
const GAP = 10;
const POINT = 7;

/**
 * Places for the names of points, in the order given: the first ones go first, what finds no place is left out.
 *
 * All in px, inside the ends given; a name is tried to the right of its point, then to the left.
 */
export function placeLabels(
  points: readonly Labelled[],
  [from, to]: readonly [number, number],
): PlacedLabel[] {
  const taken: Box[] = points.map(({ x, y }) => around(x, y));
  const placed: PlacedLabel[] = [];
  for (const { id, x, y, text } of points) {
    const length = text.length * CHARACTER;
    for (const anchor of ["start", "end"] as const) {
      const left = anchor === "start" ? x + GAP : x - GAP - length;
      const box = { left, right: left + length, top: y - LINE / 2, bottom: y + LINE / 2 };
      if (box.left < from || box.right > to) continue;
      const own = around(x, y);
      if (taken.some((other) => !same(other, own) && overlap(box, other))) continue;
      taken.push(box);
      placed.push({ id, x: anchor === "start" ? x + GAP : x - GAP, y, text, anchor });
      break;
    }
  }
  return placed;
}

function around(x: number, y: number): Box {
  return { left: x - POINT, right: x + POINT, top: y - POINT, bottom: y + POINT };
}

function same(a: Box, b: Box): boolean {
  return a.left === b.left && a.top === b.top && a.right === b.right;
}

function overlap(a: Box, b: Box): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
