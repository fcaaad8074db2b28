/**
 * Loads images for the canvas, and the neighbours' ahead of time.
 *
 * Pixels count as stored. Browsers turn a bitmap by its EXIF orientation whatever `imageOrientation` says, so
 * the server removes it from what it serves for display; a turned image is refused here, never shown.
 */

import { problemFrom, unreachable } from "../api/problem";
import type { Size } from "./viewport";

/** Decoded images are large (8 MP take 32 MB): this one, its neighbours and one more. */
const CAPACITY = 4;

export class ImageLoader {
  private readonly images = new Map<string, Promise<ImageBitmap>>();

  /** @param size What the image measures as stored. */
  load(url: string, size: Size): Promise<ImageBitmap> {
    const known = this.images.get(url);
    if (known !== undefined) {
      this.images.delete(url);
      this.images.set(url, known);
      return known;
    }
    const loading = fetchBitmap(url, size);
    this.images.set(url, loading);
    // A failure isn't remembered: the next attempt asks again.
    loading.catch(() => this.images.delete(url));
    this.forgetOldest();
    return loading;
  }

  private forgetOldest(): void {
    while (this.images.size > CAPACITY) {
      const oldest = this.images.keys().next().value;
      if (oldest === undefined) return;
      this.images.delete(oldest);
    }
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
