/** Lines, merged into few paths per style: casings first, so that none covers a neighbour's colour. */

import { at } from "../geometry";
import { CASING, type LineStyle } from "../style";
import type { Viewport } from "../viewport";
import type { PackedLines } from "./packed_lines";
import { tracePolyline } from "./surface";

/** Lines that share a path: one path for all takes browsers thrice as long, one for each longer too. */
const PER_PATH = 8;

/** What a drawing has to know of each line, by index in the scene. */
export interface LineLook {
  /** All styles there are, in drawing order; at most 256. */
  readonly styles: readonly LineStyle[];
  /** One of the styles. */
  readonly style: (index: number) => LineStyle;
  readonly visible: (index: number) => boolean;
}

/** Draws lines; the context is in CSS px of the screen. */
export function drawLines(
  context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
  lines: PackedLines,
  styles: readonly LineStyle[],
  viewport: Viewport,
): void {
  const paths = styles.map(() => new Map<number, Path2D>());
  lines.indices.forEach((index, place) => {
    const ofStyle = paths[at(lines.styles, place)];
    if (ofStyle === undefined) return;
    // By index, so that a part that is drawn again looks as it did.
    const part = Math.floor(index / PER_PATH);
    const path = ofStyle.get(part) ?? new Path2D();
    ofStyle.set(part, path);
    const [first, end] = [at(lines.offsets, place), at(lines.offsets, place + 1)];
    tracePolyline(path, lines.coordinates, first, end, viewport);
  });
  // Between the shallow angles of an edge a round joint looks the same and takes far longer.
  context.lineJoin = "bevel";
  context.lineCap = "butt";
  styles.forEach((style, place) => {
    if (style.casings === undefined) strokeStyle(context, style, paths[place], CASING.colour, CASING.extra);
    for (const { colour, extra } of style.casings ?? []) {
      strokeStyle(context, { ...style, dash: [] }, paths[place], colour, extra);
    }
  });
  styles.forEach((style, place) => {
    strokeStyle(context, style, paths[place], style.colour, 0);
  });
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function strokeStyle(
  context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
  style: LineStyle,
  paths: ReadonlyMap<number, Path2D> | undefined,
  colour: string,
  extra: number,
): void {
  if (paths === undefined || paths.size === 0) return;
  context.globalAlpha = style.opacity;
  context.setLineDash([...style.dash]);
  context.lineWidth = style.width + extra;
  context.strokeStyle = colour;
  for (const path of paths.values()) context.stroke(path);
}
