import { useEffect, useState } from "react";
import { displayUrl } from "../../api/endpoints";
import { ImageLoader, requireStoredSize } from "../../canvas/image_loader";
import type { Size } from "../../canvas/viewport";

export const imageLoader = new ImageLoader();

interface LoadedBitmap {
  imageId: number;
  bitmap: ImageBitmap | null;
  error: unknown;
}

export interface BitmapState {
  bitmap: ImageBitmap | null;
  error: unknown;
  retry: () => void;
}

/** The pixels of an image; null while they are on their way. */
export function useImageBitmap(imageId: number, { width, height }: Size): BitmapState {
  const [loaded, setLoaded] = useState<LoadedBitmap | null>(null);
  const [attempt, setAttempt] = useState(0);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another attempt loads the same image again
  useEffect(() => {
    let wanted = true;
    const finish = (result: Omit<LoadedBitmap, "imageId">) => {
      if (wanted) setLoaded({ imageId, ...result });
    };
    imageLoader
      .load(displayUrl(imageId))
      .then((bitmap) => {
        requireStoredSize(bitmap, { width, height });
        finish({ bitmap, error: null });
      })
      .catch((error: unknown) => finish({ bitmap: null, error }));
    return () => {
      wanted = false;
    };
  }, [imageId, width, height, attempt]);
  const current = loaded?.imageId === imageId ? loaded : null;
  return {
    bitmap: current?.bitmap ?? null,
    error: current?.error ?? null,
    retry: () => {
      setLoaded(null);
      setAttempt((count) => count + 1);
    },
  };
}
