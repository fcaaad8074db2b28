/** What tools ask of the view they work on. */

import type { Point } from "../../canvas/geometry";
import type { Hit } from "../../canvas/scene";

/** Finds visible lines; positions in image px, radii in screen px. */
export interface LineFinder {
  linesAlong(from: Point, to: Point, radius: number): number[];
  linesNear(at: Point, radius: number): Hit[];
  linesWithin(polygon: readonly Point[]): number[];
  redrawTool(): void;
}

/** Movement below this is a click with an unsteady hand (screen px). */
const CLICK_SLACK = 4;

export function isDrag(pressed: Point, now: Point): boolean {
  return Math.hypot(now.x - pressed.x, now.y - pressed.y) >= CLICK_SLACK;
}
