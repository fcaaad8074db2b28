import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useSyncExternalStore } from "react";
import { keys } from "../api/queries";
import type { UploadSnapshot } from "./upload_queue";
import { onUploadStored, uploads } from "./upload_start";

const REFRESH_MS = 1_500;

export function useUploads(): UploadSnapshot {
  return useSyncExternalStore(
    (listener) => uploads.subscribe(listener),
    () => uploads.snapshot,
  );
}

/** Lists follow what arrives, but not for each of hundreds of batches. */
export function useRefreshAfterUploads(): void {
  const client = useQueryClient();
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | null = null;
    const refresh = () => {
      timer = null;
      void client.invalidateQueries({ queryKey: keys.datasets });
    };
    const stop = onUploadStored(() => {
      timer ??= setTimeout(refresh, uploads.snapshot.active ? REFRESH_MS : 0);
    });
    return () => {
      stop();
      if (timer !== null) clearTimeout(timer);
    };
  }, [client]);
}
