/** The part of an image that shows a line with something around it. All in image px. */

import type { FrameSize } from "../../../charts/frame_cells";

/** Left, top, right, bottom. */
export type CornerBox = readonly [number, number, number, number];

/** Width by height. */
const ASPECT = 1.6;
/** Around the line, as a share of its extent. */
const MARGIN = 0.15;
const LEAST_WIDTH = 60;

/** A rectangle of a fixed shape with a box in its middle, moved into the image where it would stick out. */
export function cropAround([left, top, right, bottom]: CornerBox, image: FrameSize) {
  const wide = (right - left) * (1 + 2 * MARGIN);
  const high = (bottom - top) * (1 + 2 * MARGIN);
  const width = Math.max(LEAST_WIDTH, wide, high * ASPECT);
  const height = width / ASPECT;
  return {
    x: within((left + right - width) / 2, width, image.width),
    y: within((top + bottom - height) / 2, height, image.height),
    width,
    height,
  };
}

/** Where an interval begins that lies in `[0, whole]`, or around its middle if it is longer. */
function within(start: number, length: number, whole: number): number {
  return length > whole ? (whole - length) / 2 : Math.min(Math.max(0, start), whole - length);
}
