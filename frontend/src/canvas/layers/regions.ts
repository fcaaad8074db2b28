/** Parts of a bitmap that are drawn by themselves, in whole canvas px, so that no seam shows. */

import { type Box, boxOf, growBox } from "../geometry";
import type { Scene } from "../scene";
import { toImage, toScreen, type Viewport } from "../viewport";

/** Wider than half the widest line with its casing (screen px). */
const LINE_REACH = 5;
/** A line is covered by this many boxes at most: one box around a diagonal would be mostly empty. */
const PIECES = 10;

/** The canvas px that show an image box. */
export function canvasBox(box: Box, viewport: Viewport, ratio: number, margin: number): Box {
  const topLeft = toScreen(viewport, box.minX, box.minY);
  const bottomRight = toScreen(viewport, box.maxX, box.maxY);
  return {
    minX: Math.floor((topLeft.x - LINE_REACH) * ratio) + margin,
    minY: Math.floor((topLeft.y - LINE_REACH) * ratio) + margin,
    maxX: Math.ceil((bottomRight.x + LINE_REACH) * ratio) + margin,
    maxY: Math.ceil((bottomRight.y + LINE_REACH) * ratio) + margin,
  };
}

/** The image box whose lines reach into a box of canvas px. */
export function imageBox(box: Box, viewport: Viewport, ratio: number, margin: number): Box {
  const topLeft = toImage(viewport, (box.minX - margin) / ratio, (box.minY - margin) / ratio);
  const bottomRight = toImage(viewport, (box.maxX - margin) / ratio, (box.maxY - margin) / ratio);
  const seen = { minX: topLeft.x, minY: topLeft.y, maxX: bottomRight.x, maxY: bottomRight.y };
  return growBox(seen, LINE_REACH / viewport.scale);
}

/** Image boxes that together cover a polyline closely. */
export function boxesAlong({ polylines }: Scene, index: number): Box[] {
  const { coordinates, offsets } = polylines;
  const first = offsets[index] as number;
  const end = offsets[index + 1] as number;
  const step = Math.max(1, Math.ceil((end - first) / PIECES));
  const boxes: Box[] = [];
  for (let start = first; start < end; start += step) {
    // One point more, so that the pieces touch.
    boxes.push(boxOf(coordinates, start, Math.min(end, start + step + 1)));
  }
  return boxes;
}
