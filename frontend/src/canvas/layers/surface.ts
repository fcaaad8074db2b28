/** A canvas that has as many pixels as the screen shows of it. */

import type { Box } from "../geometry";
import type { Size, Viewport } from "../viewport";

export interface Surface {
  readonly canvas: HTMLCanvasElement;
  readonly context: CanvasRenderingContext2D;
  /** Nothing has been drawn since it was cleared: to clear it again would only have it put on the screen again. */
  blank: boolean;
}

export function makeSurface(canvas: HTMLCanvasElement): Surface {
  const context = canvas.getContext("2d");
  if (context === null) throw new Error("This browser gives no 2D canvas.");
  return { canvas, context, blank: false };
}

/** @param margin Canvas px beyond the screen on each side. */
export function resizeSurface(surface: Surface, screen: Size, ratio: number, margin = 0): void {
  const { canvas } = surface;
  const width = Math.max(1, Math.round(screen.width * ratio) + 2 * margin);
  const height = Math.max(1, Math.round(screen.height * ratio) + 2 * margin);
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
  surface.blank = true;
}

export function clearSurface(surface: Surface): void {
  const { canvas, context } = surface;
  context.setTransform(1, 0, 0, 1, 0, 0);
  if (!surface.blank) context.clearRect(0, 0, canvas.width, canvas.height);
  surface.blank = true;
}

/** Lets the context draw in CSS px of the screen. */
export function setScreenUnits(surface: Surface, ratio: number, margin = 0): void {
  surface.context.setTransform(ratio, 0, 0, ratio, margin, margin);
  surface.blank = false;
}

/** Draws a bitmap, in canvas px, on what has just been cleared. */
export function drawBitmap(
  surface: Surface,
  bitmap: CanvasImageSource,
  { minX, minY, maxX, maxY }: Box,
): void {
  surface.context.drawImage(bitmap, minX, minY, maxX - minX, maxY - minY);
  surface.blank = false;
}

/** Adds one polyline in image px to a path in screen px. */
export function tracePolyline(
  path: Path2D | CanvasRenderingContext2D,
  coordinates: Float32Array,
  first: number,
  end: number,
  viewport: Viewport,
): void {
  const { scale } = viewport;
  const shiftX = viewport.offsetX + 0.5 * scale;
  const shiftY = viewport.offsetY + 0.5 * scale;
  path.moveTo(
    (coordinates[2 * first] as number) * scale + shiftX,
    (coordinates[2 * first + 1] as number) * scale + shiftY,
  );
  for (let i = first + 1; i < end; i++) {
    path.lineTo(
      (coordinates[2 * i] as number) * scale + shiftX,
      (coordinates[2 * i + 1] as number) * scale + shiftY,
    );
  }
}

/** Strokes a path; dashes end bluntly and whole lines round, unless told otherwise. */
export function strokePath(
  context: CanvasRenderingContext2D,
  path: Path2D,
  colour: string,
  width: number,
  dash: readonly number[] = [],
  cap: CanvasLineCap = dash.length > 0 ? "butt" : "round",
): void {
  context.lineJoin = "round";
  context.lineCap = cap;
  context.setLineDash([...dash]);
  context.lineWidth = width;
  context.strokeStyle = colour;
  context.stroke(path);
}
