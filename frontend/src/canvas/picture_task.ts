/** Draws lines on a bitmap of their own. Runs in a worker, or in the page. */

import type { Frame } from "./frame";
import { drawLines } from "./layers/line_layer";
import type { PackedLines } from "./layers/packed_lines";
import type { LineStyle } from "./style";

export interface Drawing {
  readonly lines: PackedLines;
  readonly styles: readonly LineStyle[];
  readonly frame: Frame;
}

export function drawPicture({ lines, styles, frame }: Drawing): ImageBitmap {
  const { viewport, ratio, margin, width, height } = frame;
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d");
  if (context === null) throw new Error("This browser gives no 2D canvas.");
  context.setTransform(ratio, 0, 0, ratio, margin, margin);
  drawLines(context, lines, styles, viewport);
  return canvas.transferToImageBitmap();
}
