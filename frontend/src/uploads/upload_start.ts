/** The tool's one upload queue, on the browser's network. It goes on while pages change. */

import { sendFiles } from "../api/upload";
import { UploadQueue } from "./upload_queue";

type StoredListener = (slug: string) => void;
const storedListeners = new Set<StoredListener>();

export const uploads = new UploadQueue({
  send: sendFiles,
  now: () => performance.now(),
  limits: { files: 20, bytes: 32e6, wholeBytes: 1e9 },
  parallel: 3,
  onStored: (slug) => {
    for (const listener of storedListeners) listener(slug);
  },
});

/** Hears of each batch that arrived until the returned function is called. */
export function onUploadStored(listener: StoredListener): () => void {
  storedListeners.add(listener);
  return () => storedListeners.delete(listener);
}

/** Asks before the page is left while something is under way. */
export function guardUploads(): void {
  window.addEventListener("beforeunload", (event) => {
    if (uploads.snapshot.active) event.preventDefault();
  });
}
