/** Strokes that judge what they touch, as one group; a click judges the nearest line. */

import type { Verdict } from "../../api/types";
import type { Point } from "../../canvas/geometry";
import type { PointerTool } from "../../canvas/pointer_tool";
import { BRUSH } from "../../canvas/style";
import { toScreen, type Viewport } from "../../canvas/viewport";
import type { Preview } from "./preview";
import { isDrag, type LineFinder } from "./tool_view";

/** How far from the stroke's middle a line is still touched (screen px). */
export const BRUSH_RADIUS = 8;

/** A stroke under way or done; candidates by index. */
export interface Stroke {
  readonly touched: ReadonlySet<number>;
  /** The line that it begins on; null: beside the lines. */
  readonly first: number | null;
  /** The line that it ends on, as far as it has come. */
  readonly last: number | null;
}

export type Verdicts = ReadonlyMap<number, Verdict>;

interface BrushParts {
  readonly colour: () => string;
  readonly view: () => LineFinder | null;
  readonly preview: Preview;
  /** The verdicts that a stroke gives. */
  readonly effect: (stroke: Stroke) => Verdicts;
  readonly judge: (verdicts: Verdicts) => void;
}

export class BrushTool implements PointerTool {
  readonly cursor = "none";
  private readonly parts: BrushParts;
  /** Where the pointer rests (image px); null while it is elsewhere. */
  private place: Point | null = null;
  /** The stroke under way (image px). */
  private stroke: Point[] = [];
  private pressed: Point | null = null;
  private dragged = false;
  private touched = new Set<number>();
  private first: number | null = null;

  constructor(parts: BrushParts) {
    this.parts = parts;
  }

  down(at: Point, screen: Point): void {
    this.place = at;
    this.pressed = screen;
    this.dragged = false;
    this.stroke = [at];
    this.first = this.nearest(at);
    this.touched = only(this.first);
    this.show(at);
  }

  move(at: Point, screen: Point): void {
    if (this.pressed === null) return;
    this.place = at;
    if (!this.dragged && !isDrag(this.pressed, screen)) return;
    if (!this.dragged) this.touched.clear();
    this.dragged = true;
    const before = this.stroke.at(-1) ?? at;
    this.stroke.push(at);
    for (const index of this.parts.view()?.linesAlong(before, at, BRUSH_RADIUS) ?? [])
      this.touched.add(index);
    this.show(at);
  }

  up(at: Point, screen: Point): void {
    this.move(at, screen);
    const verdicts = this.effect(at);
    this.rest(at);
    if (verdicts.size > 0) this.parts.judge(verdicts);
  }

  cancel(): void {
    this.rest(null);
  }

  hover(at: Point | null): void {
    this.place = at;
    if (at === null) this.parts.preview.clear();
    else {
      const line = this.nearest(at);
      this.parts.preview.show(this.parts.effect({ touched: only(line), first: line, last: line }));
    }
    this.parts.view()?.redrawTool();
  }

  draw(context: CanvasRenderingContext2D, viewport: Viewport): void {
    const colour = this.parts.colour();
    if (this.dragged) drawStroke(context, viewport, this.stroke, colour);
    if (this.place !== null) drawRing(context, toScreen(viewport, this.place.x, this.place.y), colour);
  }

  private nearest(at: Point): number | null {
    return this.parts.view()?.linesNear(at, BRUSH_RADIUS)[0]?.index ?? null;
  }

  private effect(at: Point): Verdicts {
    const last = this.dragged ? this.nearest(at) : this.first;
    return this.parts.effect({ touched: this.touched, first: this.first, last });
  }

  private rest(place: Point | null): void {
    this.place = place;
    this.pressed = null;
    this.dragged = false;
    this.stroke = [];
    this.touched = new Set();
    this.first = null;
    this.parts.preview.clear();
    this.parts.view()?.redrawTool();
  }

  private show(at: Point): void {
    this.parts.preview.show(this.effect(at));
    this.parts.view()?.redrawTool();
  }
}

function only(line: number | null): Set<number> {
  return new Set(line === null ? [] : [line]);
}

function drawStroke(
  context: CanvasRenderingContext2D,
  viewport: Viewport,
  stroke: readonly Point[],
  colour: string,
): void {
  context.save();
  context.beginPath();
  for (const { x, y } of stroke) {
    const place = toScreen(viewport, x, y);
    context.lineTo(place.x, place.y);
  }
  context.lineCap = "round";
  context.lineJoin = "round";
  context.lineWidth = 2 * BRUSH_RADIUS;
  context.globalAlpha = BRUSH.opacity;
  context.strokeStyle = colour;
  context.stroke();
  context.restore();
}

function drawRing(context: CanvasRenderingContext2D, { x, y }: Point, colour: string): void {
  for (const { width, stroke } of [
    { width: BRUSH.rim + 2, stroke: BRUSH.casing },
    { width: BRUSH.rim, stroke: colour },
  ]) {
    context.beginPath();
    context.arc(x, y, BRUSH_RADIUS, 0, 2 * Math.PI);
    context.lineWidth = width;
    context.strokeStyle = stroke;
    context.stroke();
  }
}
