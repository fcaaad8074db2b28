/** What the comparison of an image before and after consists of, drawn in screen px. */

import { strokePath, tracePolyline } from "../../../canvas/layers/surface";
import type { Scene } from "../../../canvas/scene";
import type { Size, Viewport } from "../../../canvas/viewport";

/** Beyond this many screen px per image px the pixels themselves are what one wants to see. */
const PIXELS_VISIBLE = 3;
/** Lines of the ruler across the image's longer side. */
const RULERS = 16;
const CASING = "rgba(6, 10, 16, 0.62)";

export function drawPicture(
  context: CanvasRenderingContext2D,
  picture: CanvasImageSource | null,
  size: Size,
  { scale, offsetX, offsetY }: Viewport,
): void {
  if (picture === null) return;
  context.imageSmoothingEnabled = scale < PIXELS_VISIBLE;
  context.imageSmoothingQuality = scale < 0.5 ? "medium" : "low";
  context.drawImage(picture, offsetX, offsetY, size.width * scale, size.height * scale);
}

/** Straight lines to hold against what is straight in the world: they are the same on both sides. */
export function drawRuler(context: CanvasRenderingContext2D, size: Size, viewport: Viewport): void {
  const step = Math.max(size.width, size.height) / RULERS;
  const { scale, offsetX, offsetY } = viewport;
  const [right, bottom] = [offsetX + size.width * scale, offsetY + size.height * scale];
  const path = new Path2D();
  for (let at = step; at < size.width - 1; at += step) {
    path.moveTo(offsetX + at * scale, offsetY);
    path.lineTo(offsetX + at * scale, bottom);
  }
  for (let at = step; at < size.height - 1; at += step) {
    path.moveTo(offsetX, offsetY + at * scale);
    path.lineTo(right, offsetY + at * scale);
  }
  strokePath(context, path, "rgba(6, 10, 16, 0.4)", 2);
  strokePath(context, path, "rgba(255, 255, 255, 0.75)", 1);
}

export function drawLines(
  context: CanvasRenderingContext2D,
  scene: Scene,
  colours: readonly string[],
  viewport: Viewport,
  marked: number | null,
): void {
  const byColour = new Map<string, Path2D>();
  const all = new Path2D();
  for (let index = 0; index < scene.count; index++) {
    const colour = colours[index] ?? "#ffffff";
    const path = byColour.get(colour) ?? new Path2D();
    byColour.set(colour, path);
    traceLine(path, scene, index, viewport);
    traceLine(all, scene, index, viewport);
  }
  strokePath(context, all, CASING, 4.2);
  for (const [colour, path] of byColour) strokePath(context, path, colour, 2);
  if (marked === null || marked >= scene.count) return;
  const line = new Path2D();
  traceLine(line, scene, marked, viewport);
  strokePath(context, line, "rgba(6, 10, 16, 0.85)", 7.5);
  strokePath(context, line, "#ffffff", 5);
  strokePath(context, line, colours[marked] ?? "#ffffff", 2.4);
}

function traceLine(path: Path2D, { polylines }: Scene, index: number, viewport: Viewport): void {
  const first = polylines.offsets[index] ?? 0;
  const end = polylines.offsets[index + 1] ?? first;
  if (end > first) tracePolyline(path, polylines.coordinates, first, end, viewport);
}
