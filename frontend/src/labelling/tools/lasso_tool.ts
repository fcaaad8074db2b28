/** Selects what a drawn loop goes around; with Shift in addition to what is selected. A click selects one line. */

import type { Point } from "../../canvas/geometry";
import type { PointerTool } from "../../canvas/pointer_tool";
import { LASSO } from "../../canvas/style";
import { toScreen, type Viewport } from "../../canvas/viewport";
import type { Preview } from "./preview";
import { isDrag, type LineFinder } from "./tool_view";

/** Corners of the loop are at least this far apart (screen px): finer ones cost time and tell nothing. */
const CORNER_DISTANCE = 4;
const CLICK_REACH = 8;

interface LassoParts {
  readonly view: () => LineFinder | null;
  readonly preview: Preview;
  /** Selects these, in addition to what is selected or in its place. */
  readonly select: (indices: readonly number[], additional: boolean) => void;
}

export class LassoTool implements PointerTool {
  readonly cursor = "crosshair";
  private readonly parts: LassoParts;
  /** The loop under way (image px). */
  private loop: Point[] = [];
  private pressed: Point | null = null;
  private last: Point | null = null;
  private dragged = false;
  private additional = false;

  constructor(parts: LassoParts) {
    this.parts = parts;
  }

  down(at: Point, screen: Point, shift: boolean): void {
    this.pressed = screen;
    this.last = screen;
    this.dragged = false;
    this.additional = shift;
    this.loop = [at];
  }

  move(at: Point, screen: Point): void {
    const { pressed, last } = this;
    if (pressed === null || last === null) return;
    this.dragged ||= isDrag(pressed, screen);
    if (Math.hypot(screen.x - last.x, screen.y - last.y) < CORNER_DISTANCE) return;
    this.last = screen;
    this.loop.push(at);
    const inside = this.parts.view()?.linesWithin(this.loop) ?? [];
    this.parts.preview.show(new Map(inside.map((index) => [index, null])));
    this.parts.view()?.redrawTool();
  }

  up(at: Point): void {
    const { additional, dragged, loop } = this;
    const view = this.parts.view();
    const found = dragged
      ? (view?.linesWithin([...loop, at]) ?? [])
      : (view?.linesNear(at, CLICK_REACH) ?? []).slice(0, 1).map(({ index }) => index);
    this.rest();
    this.parts.select(found, additional);
  }

  cancel(): void {
    this.rest();
  }

  draw(context: CanvasRenderingContext2D, viewport: Viewport): void {
    if (!this.dragged) return;
    context.save();
    context.beginPath();
    for (const { x, y } of this.loop) {
      const place = toScreen(viewport, x, y);
      context.lineTo(place.x, place.y);
    }
    context.closePath();
    context.fillStyle = LASSO.fill;
    context.fill("evenodd");
    context.lineWidth = LASSO.width + 2;
    context.strokeStyle = LASSO.casing;
    context.stroke();
    context.lineWidth = LASSO.width;
    context.setLineDash([...LASSO.dash]);
    context.strokeStyle = LASSO.colour;
    context.stroke();
    context.restore();
  }

  private rest(): void {
    this.loop = [];
    this.pressed = null;
    this.last = null;
    this.dragged = false;
    this.parts.preview.clear();
    this.parts.view()?.redrawTool();
  }
}
