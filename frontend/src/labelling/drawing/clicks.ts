/** The points clicked along an edge, in the order of the edge. */

import type { Point } from "../../canvas/geometry";

/** The server takes no more. */
export const MOST_CLICKS = 20;

/**
 * The points with one more, put where it belongs: between two of them, or before the first or after the last.
 *
 * An edge is nearly straight, so the place along the line from the first to the last tells the order.
 */
export function withClick(clicks: readonly Point[], added: Point): Point[] {
  const first = clicks[0];
  const last = clicks.at(-1);
  if (first === undefined || last === undefined || clicks.length < 2) return [...clicks, added];
  const along = ({ x, y }: Point) => (x - first.x) * (last.x - first.x) + (y - first.y) * (last.y - first.y);
  const place = clicks.findIndex((click) => along(click) > along(added));
  return place < 0 ? [...clicks, added] : [...clicks.slice(0, place), added, ...clicks.slice(place)];
}
