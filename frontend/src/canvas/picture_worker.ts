/** The worker that draws lines on bitmaps, one after the other. */

import { type Drawing, drawPicture } from "./picture_task";

export interface DrawingGiven {
  readonly ticket: number;
  readonly drawing: Drawing;
}

export interface PictureDrawn {
  readonly ticket: number;
  readonly picture?: ImageBitmap;
  /** What went wrong, in words. */
  readonly failure?: string;
}

self.addEventListener("message", ({ data }: MessageEvent<DrawingGiven>) => {
  const { ticket, drawing } = data;
  try {
    const picture = drawPicture(drawing);
    self.postMessage({ ticket, picture } satisfies PictureDrawn, { transfer: [picture] });
  } catch (error) {
    const failure = error instanceof Error ? error.message : String(error);
    self.postMessage({ ticket, failure } satisfies PictureDrawn);
  }
});
