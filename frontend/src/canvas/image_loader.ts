/**
 * Loads images for the canvas, and the neighbours' ahead of time.
 *
 * Pixels count as stored. Browsers turn a bitmap by its EXIF orientation whatever `imageOrientation` says, so
 * the server removes it from what it serves for display; a turned image is refused here, never shown.
 */

import { problemFrom, unreachable } from "../api/problem";
import type { Size } from "./viewport";

/** Decoded images are large, 4 bytes per pixel: 256 MB. The one that is shown is kept whatever it measures. */
const MOST_PIXELS = 64e6;

interface Kept {
  readonly bitmap: Promise<ImageBitmap>;
  readonly pixels: number;
}

export class ImageLoader {
  /** The latest asked for is the last. */
  private readonly images = new Map<string, Kept>();

  /** @param size What the image measures as stored. */
  load(url: string, size: Size): Promise<ImageBitmap> {
    const known = this.images.get(url);
    if (known !== undefined) {
      this.images.delete(url);
      this.images.set(url, known);
      return known.bitmap;
    }
    const bitmap = fetchBitmap(url, size);
    this.images.set(url, { bitmap, pixels: size.width * size.height });
    // A failure isn't remembered: the next attempt asks again.
    bitmap.catch(() => this.images.delete(url));
    this.forgetOldest();
    return bitmap;
  }

  /** Loads an image that may be wanted soon, unless it is so large that the shown one would have to go. */
  async prefetch(url: string, size: Size): Promise<void> {
    const pixels = size.width * size.height;
    if (this.images.has(url) || 2 * pixels > MOST_PIXELS) return;
    await this.load(url, size).catch(() => undefined);
  }

  private forgetOldest(): void {
    let pixels = 0;
    const latestFirst = [...this.images].reverse();
    latestFirst.forEach(([url, kept], place) => {
      pixels += kept.pixels;
      if (place > 0 && pixels > MOST_PIXELS) this.images.delete(url);
    });
  }
}

async function fetchBitmap(url: string, size: Size): Promise<ImageBitmap> {
  const response = await fetch(url).catch(() => {
    throw unreachable();
  });
  if (!response.ok) throw problemFrom(await response.json().catch(() => null), response);
  const blob = await response.blob();
  const bitmap = await createImageBitmap(blob, { colorSpaceConversion: "none" });
  if (bitmap.width !== size.width || bitmap.height !== size.height) {
    const seen = `${bitmap.width} × ${bitmap.height}`;
    throw new Error(`The image arrived as ${seen} px instead of ${size.width} × ${size.height} px.`);
  }
  return bitmap;
}
