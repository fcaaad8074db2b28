/** Lines, merged into few paths per style: casings first, so that none covers a neighbour's colour. */

import { at } from "../geometry";
import type { Scene } from "../scene";
import { CASING, type LineStyle } from "../style";
import type { Viewport } from "../viewport";
import { tracePolyline } from "./surface";

/** Lines that share a path: one path for all takes browsers thrice as long, one for each longer too. */
const PER_PATH = 8;

/** What a drawing has to know of each line, by index in the scene. */
export interface LineLook {
  /** All styles there are, in drawing order. */
  readonly styles: readonly LineStyle[];
  /** One of the styles. */
  readonly style: (index: number) => LineStyle;
  readonly visible: (index: number) => boolean;
}

/** Draws the given lines; the context is in CSS px of the screen. */
export function drawLines(
  context: CanvasRenderingContext2D,
  scene: Scene,
  look: LineLook,
  viewport: Viewport,
  indices: Iterable<number>,
): void {
  const { offsets, coordinates } = scene.atScale(viewport.scale);
  const paths = new Map<LineStyle, Map<number, Path2D>>();
  for (const index of indices) {
    if (!look.visible(index)) continue;
    const style = look.style(index);
    const ofStyle = paths.get(style) ?? new Map<number, Path2D>();
    paths.set(style, ofStyle);
    // By index, so that a part that is drawn again looks as it did.
    const part = Math.floor(index / PER_PATH);
    const path = ofStyle.get(part) ?? new Path2D();
    ofStyle.set(part, path);
    tracePolyline(path, coordinates, at(offsets, index), at(offsets, index + 1), viewport);
  }
  // Between the shallow angles of an edge a round joint looks the same and takes far longer.
  context.lineJoin = "bevel";
  context.lineCap = "butt";
  for (const style of look.styles) {
    strokeStyle(context, style, paths.get(style), CASING.colour, CASING.extra);
  }
  for (const style of look.styles) strokeStyle(context, style, paths.get(style), style.colour, 0);
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function strokeStyle(
  context: CanvasRenderingContext2D,
  style: LineStyle,
  paths: ReadonlyMap<number, Path2D> | undefined,
  colour: string,
  extra: number,
): void {
  if (paths === undefined) return;
  context.globalAlpha = style.opacity;
  context.setLineDash([...style.dash]);
  context.lineWidth = style.width + extra;
  context.strokeStyle = colour;
  for (const path of paths.values()) context.stroke(path);
}
