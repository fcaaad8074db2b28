/** Clicks put points along an edge, a double click accepts the line; a drag puts both its ends. */

import type { Point } from "../../canvas/geometry";
import type { PointerTool } from "../../canvas/pointer_tool";
import { TRACE } from "../../canvas/style";
import { toScreen, type Viewport } from "../../canvas/viewport";
import { isDrag } from "../tools/tool_view";
import type { TraceSession } from "./trace_session";

/** Two clicks closer to each other than this, in time (ms), are one double click. */
const DOUBLE = 400;

interface ToolParts {
  readonly session: TraceSession;
  readonly accept: () => void;
  /** Milliseconds of a clock that never jumps. */
  readonly now: () => number;
  /** A place in the image at or next to another one. */
  readonly inside: (at: Point) => Point;
}

export class TraceTool implements PointerTool {
  readonly cursor = "crosshair";
  private readonly parts: ToolParts;
  private pressed: { at: Point; screen: Point } | null = null;
  private last: { screen: Point; time: number } | null = null;

  constructor(parts: ToolParts) {
    this.parts = parts;
  }

  down(at: Point, screen: Point): void {
    this.pressed = { at: this.parts.inside(at), screen };
  }

  move(at: Point, screen: Point): void {
    const { pressed } = this;
    if (pressed === null || !isDrag(pressed.screen, screen)) return;
    if (this.parts.session.getState().clicks.length === 0) this.parts.session.click(pressed.at);
    this.parts.session.hover(this.parts.inside(at));
  }

  up(at: Point, screen: Point): void {
    const { pressed, last } = this;
    this.pressed = null;
    if (pressed === null) return;
    const time = this.parts.now();
    const again = last !== null && time - last.time < DOUBLE && !isDrag(last.screen, screen);
    this.last = again ? null : { screen, time };
    if (again) this.parts.accept();
    else this.parts.session.click(this.parts.inside(at));
  }

  cancel(): void {
    this.pressed = null;
  }

  hover(at: Point | null): void {
    this.parts.session.hover(at === null ? null : this.parts.inside(at));
  }

  draw(context: CanvasRenderingContext2D, viewport: Viewport): void {
    const { clicks, trace } = this.parts.session.getState();
    const places = clicks.map(({ x, y }) => toScreen(viewport, x, y));
    context.save();
    context.lineJoin = "round";
    context.lineCap = "round";
    if (trace !== null) drawLine(context, screenPlaces(trace.points, viewport), []);
    else if (places.length > 1) drawLine(context, places, TRACE.missing);
    for (const place of places) drawPoint(context, place);
    context.restore();
  }
}

function screenPlaces(points: readonly (readonly number[])[], viewport: Viewport): Point[] {
  return points.map(([x = 0, y = 0]) => toScreen(viewport, x, y));
}

function drawLine(
  context: CanvasRenderingContext2D,
  places: readonly Point[],
  dash: readonly number[],
): void {
  context.beginPath();
  for (const { x, y } of places) context.lineTo(x, y);
  for (const [width, colour, pattern] of [
    [TRACE.width + 3, TRACE.casing, []],
    [TRACE.width, TRACE.colour, dash],
  ] as const) {
    context.setLineDash([...pattern]);
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.stroke();
  }
  context.setLineDash([]);
}

function drawPoint(context: CanvasRenderingContext2D, { x, y }: Point): void {
  context.beginPath();
  context.arc(x, y, TRACE.point, 0, 2 * Math.PI);
  context.fillStyle = TRACE.colour;
  context.fill();
  context.lineWidth = 2;
  context.strokeStyle = TRACE.casing;
  context.stroke();
}
