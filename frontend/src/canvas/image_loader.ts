/**
 * Loads images for the canvas, and the neighbours' ahead of time.
 *
 * Pixels count as stored. Browsers turn a bitmap by its EXIF orientation whatever `imageOrientation` says, so
 * the server removes it from what it serves for display; a turned image is refused here, never shown.
 */

import { problemFrom, RequestFailed, unreachable } from "../api/problem";
import type { Problem } from "../api/types";
import type { Size } from "./viewport";

/** Decoded images are large, 4 bytes per pixel: 192 MB. The one that is shown is kept whatever it measures. */
const MOST_PIXELS = 48e6;

/** For so long nothing at all may come of an image, ms. */
const SILENCE = 10_000;

const UNREADABLE: Problem = {
  title: "The image can't be shown",
  status: 422,
  code: "unreadable-image",
  message: "Its file is broken or cut off.",
  hint: "Upload it again, or discard the image.",
};

interface Kept {
  readonly bitmap: Promise<ImageBitmap>;
  /** Once it is decoded. */
  decoded: ImageBitmap | null;
}

export class ImageLoader {
  /** The latest asked for is the last. */
  private readonly images = new Map<string, Kept>();

  load(url: string): Promise<ImageBitmap> {
    const known = this.images.get(url);
    if (known !== undefined) {
      this.images.delete(url);
      this.images.set(url, known);
      return known.bitmap;
    }
    const kept: Kept = { bitmap: fetchBitmap(url), decoded: null };
    this.images.set(url, kept);
    kept.bitmap.then(
      (bitmap) => {
        kept.decoded = bitmap;
        this.forgetOldest();
      },
      // A failure isn't remembered: the next attempt asks again.
      () => this.images.delete(url),
    );
    return kept.bitmap;
  }

  /** An image that is there already. */
  peek(url: string): ImageBitmap | null {
    return this.images.get(url)?.decoded ?? null;
  }

  /** Loads an image that may be wanted soon, unless it is so large that the shown one would have to go. */
  async prefetch(url: string, { width, height }: Size): Promise<void> {
    if (this.images.has(url) || 2 * width * height > MOST_PIXELS) return;
    await this.load(url).catch(() => undefined);
  }

  private forgetOldest(): void {
    let pixels = 0;
    const latestFirst = [...this.images].reverse();
    latestFirst.forEach(([url, kept], place) => {
      pixels += kept.decoded === null ? 0 : kept.decoded.width * kept.decoded.height;
      if (place > 0 && pixels > MOST_PIXELS) this.images.delete(url);
    });
  }
}

/** @throws Error where an image didn't arrive with the pixels that it has as stored. */
export function requireStoredSize(bitmap: ImageBitmap, stored: Size): void {
  if (bitmap.width === stored.width && bitmap.height === stored.height) return;
  const seen = `${bitmap.width} × ${bitmap.height}`;
  throw new Error(`The image arrived as ${seen} px instead of ${stored.width} × ${stored.height} px.`);
}

async function fetchBitmap(url: string): Promise<ImageBitmap> {
  // Once more: a network that changes at that moment breaks off what is under way, and works again at once.
  const blob = await fetchBlob(url).catch((error: RequestFailed) => {
    if (error.problem.status !== 0) throw error;
    return fetchBlob(url);
  });
  return createImageBitmap(blob, { colorSpaceConversion: "none" }).catch(() => {
    throw new RequestFailed(UNREADABLE);
  });
}

/** @throws RequestFailed with status 0 where the answer doesn't come, breaks off, or falls silent. */
async function fetchBlob(url: string): Promise<Blob> {
  const silence = new AbortController();
  let timer: ReturnType<typeof setTimeout> | undefined;
  const heard = () => {
    clearTimeout(timer);
    timer = setTimeout(() => silence.abort(), SILENCE);
  };
  heard();
  try {
    const response = await fetch(url, { signal: silence.signal }).catch(() => {
      throw unreachable();
    });
    if (!response.ok) {
      const { problem } = problemFrom(await response.json().catch(() => null), response);
      throw new RequestFailed({ ...problem, title: UNREADABLE.title });
    }
    const pieces = await piecesOf(response, heard).catch(() => {
      throw unreachable();
    });
    return new Blob(pieces, { type: response.headers.get("Content-Type") ?? "" });
  } finally {
    clearTimeout(timer);
  }
}

async function piecesOf({ body }: Response, heard: () => void): Promise<Uint8Array<ArrayBuffer>[]> {
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  const reader = body?.getReader();
  for (let read = await reader?.read(); read?.value !== undefined; read = await reader?.read()) {
    heard();
    pieces.push(read.value);
  }
  return pieces;
}
