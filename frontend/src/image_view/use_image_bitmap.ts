import { useEffect, useState } from "react";
import { ImageLoader, requireStoredSize } from "../canvas/image_loader";
import type { Size } from "../canvas/viewport";

export const imageLoader = new ImageLoader();

interface LoadedBitmap {
  url: string;
  bitmap: ImageBitmap | null;
  error: unknown;
}

export interface BitmapState {
  bitmap: ImageBitmap | null;
  error: unknown;
  retry: () => void;
}

/** The pixels at an address; null while they, or the address, are on their way. */
export function useImageBitmap(url: string | null, { width, height }: Size): BitmapState {
  const [loaded, setLoaded] = useState<LoadedBitmap | null>(null);
  const [attempt, setAttempt] = useState(0);
  const ready = url === null || loaded?.url === url ? null : readyBitmap(url, { width, height });
  // In this very rendering: what is there already is shown with everything else of the image.
  if (ready !== null) setLoaded(ready);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another attempt loads the same image again
  useEffect(() => {
    if (url === null) return;
    let wanted = true;
    const finish = (result: Omit<LoadedBitmap, "url">) => {
      const next = { url, ...result };
      if (wanted) setLoaded((before) => (sameResult(before, next) ? before : next));
    };
    imageLoader
      .load(url)
      .then((bitmap) => {
        requireStoredSize(bitmap, { width, height });
        finish({ bitmap, error: null });
      })
      .catch((error: unknown) => finish({ bitmap: null, error }));
    return () => {
      wanted = false;
    };
  }, [url, width, height, attempt]);
  const current = loaded?.url === url ? loaded : null;
  return {
    bitmap: current?.bitmap ?? null,
    error: current?.error ?? null,
    retry: () => {
      setLoaded(null);
      setAttempt((count) => count + 1);
    },
  };
}

function readyBitmap(url: string, { width, height }: Size): LoadedBitmap | null {
  const bitmap = imageLoader.peek(url);
  // One of another size is an error, which the loading tells.
  if (bitmap === null || bitmap.width !== width || bitmap.height !== height) return null;
  return { url, bitmap, error: null };
}

function sameResult(a: LoadedBitmap | null, b: LoadedBitmap): boolean {
  return a !== null && a.url === b.url && a.bitmap === b.bitmap && a.error === b.error;
}
