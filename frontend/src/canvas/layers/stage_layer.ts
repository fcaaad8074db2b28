/** How the selected candidate was found: its pieces between ticks, the gaps that were closed, what was added. */

import { at } from "../geometry";
import type { StageTrace, Stretch } from "../stage_trace";
import { middleOf } from "../stage_trace";
import { SELECTION, STAGES } from "../style";
import { toScreen, type Viewport } from "../viewport";
import { strokePath, tracePolyline } from "./surface";

/** Points that the direction at an end is read off: single ones are too rough. */
const DIRECTION_POINTS = 8;
/** Ticks that would be closer to each other than this are drawn as one (screen px). */
const LEAST_APART = 4;

/** Draws a candidate's stages; the context is in CSS px of the screen. */
export function drawStages(
  context: CanvasRenderingContext2D,
  trace: StageTrace,
  viewport: Viewport,
  markedGap: number | null,
): void {
  const { rim, bed, pieces, gap, added } = STAGES;
  const path = (parts: readonly Stretch[]) => pathOf(parts, viewport);
  context.save();
  // A bright rim for dark pixels around a dark bed for bright ones: what lies on it is seen on any image.
  strokePath(context, path([trace.whole]), rim.colour, rim.width);
  strokePath(context, path([trace.whole]), bed.colour, bed.width);
  strokePath(context, path(trace.gaps), gap.colour, gap.width, gap.dash);
  strokePath(context, path(trace.added), added.colour, added.width, added.dash, "round");
  pieces.colours.forEach((colour, turn) => {
    const ofColour = trace.pieces.filter((_, piece) => piece % pieces.colours.length === turn);
    strokePath(context, path(ofColour), colour, pieces.width, [], "butt");
  });
  drawTicks(context, trace.pieces, viewport);
  const marked = markedGap === null ? undefined : trace.gaps[markedGap];
  if (marked !== undefined) drawMark(context, marked, viewport);
  context.restore();
}

function drawTicks(context: CanvasRenderingContext2D, pieces: readonly Stretch[], viewport: Viewport): void {
  const { tick } = STAGES;
  const path = new Path2D();
  let last = { x: Number.NEGATIVE_INFINITY, y: 0 };
  for (const piece of pieces) {
    const points = piece.length / 2;
    for (const [end, inner] of [
      [0, Math.min(DIRECTION_POINTS, points - 1)],
      [points - 1, Math.max(points - 1 - DIRECTION_POINTS, 0)],
    ] as const) {
      const place = toScreen(viewport, at(piece, 2 * end), at(piece, 2 * end + 1));
      if (Math.hypot(place.x - last.x, place.y - last.y) < LEAST_APART) continue;
      last = place;
      const dx = at(piece, 2 * inner) - at(piece, 2 * end);
      const dy = at(piece, 2 * inner + 1) - at(piece, 2 * end + 1);
      const length = Math.hypot(dx, dy) || 1;
      const across = { x: (-dy / length) * tick.reach, y: (dx / length) * tick.reach };
      path.moveTo(place.x - across.x, place.y - across.y);
      path.lineTo(place.x + across.x, place.y + across.y);
    }
  }
  strokePath(context, path, SELECTION.casing, tick.width + 1.8, [], "butt");
  strokePath(context, path, tick.colour, tick.width, [], "butt");
}

/** A ring around a gap: many are shorter than a pixel of the screen. */
function drawMark(context: CanvasRenderingContext2D, gap: Stretch, viewport: Viewport): void {
  const { mark } = STAGES;
  const end = gap.length - 2;
  const length = Math.hypot(at(gap, end) - at(gap, 0), at(gap, end + 1) - at(gap, 1)) * viewport.scale;
  const middle = middleOf(gap);
  const { x, y } = toScreen(viewport, middle.x, middle.y);
  const path = new Path2D();
  path.arc(x, y, Math.max(mark.radius, length / 2 + 6), 0, 2 * Math.PI);
  strokePath(context, path, SELECTION.casing, mark.width + 3, [], "butt");
  strokePath(context, path, mark.colour, mark.width, [], "butt");
}

function pathOf(parts: readonly Stretch[], viewport: Viewport): Path2D {
  const path = new Path2D();
  for (const part of parts) tracePolyline(path, part, 0, part.length / 2, viewport);
  return path;
}
