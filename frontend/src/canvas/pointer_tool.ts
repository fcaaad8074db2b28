/** What a drag on the image does while a tool is set: strokes, a lasso, tracing a line. */

import type { Point } from "./geometry";
import type { Viewport } from "./viewport";

/**
 * Gets the main button's and one finger's drags; the middle button, two fingers and the wheel still move the view.
 * Positions come in image px and in screen px of the canvas.
 */
export interface PointerTool {
  /** Of the pointer above the image, as in CSS. */
  readonly cursor: string;
  /** A press, with Shift or without; `move` follows for each movement, then either `up` or `cancel`. */
  down(at: Point, screen: Point, shift: boolean): void;
  move(at: Point, screen: Point): void;
  up(at: Point, screen: Point): void;
  /** A second finger, Escape or another image ended the drag: nothing of it counts. */
  cancel(): void;
  /** The pointer rests or moves above the image without a button; null when it leaves. */
  hover?(at: Point | null): void;
  /** Draws above everything else, in screen px; `CanvasView.redrawTool` asks for it. */
  draw?(context: CanvasRenderingContext2D, viewport: Viewport): void;
}
