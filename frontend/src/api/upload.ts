/** Uploads. XMLHttpRequest, because fetch doesn't say how much of a request was sent. */

import { apiUrl } from "./client";
import { personHeaders } from "./person";
import { problemFrom, unreachable } from "./problem";
import type { UploadReport } from "./types";

export interface FileToSend {
  file: File;
  /** Name it is sent under: the path from the chosen folder on, with forward slashes. */
  path: string;
}

export interface SendOptions {
  /** Bytes of the request that were sent so far, and all of them. */
  onProgress: (sent: number, total: number) => void;
  signal: AbortSignal;
}

/**
 * Sends files to a dataset in one request.
 *
 * @throws RequestFailed with the server's reason, or code "unreachable".
 * @throws DOMException "AbortError" when the signal is set.
 */
export function sendFiles(
  slug: string,
  files: readonly FileToSend[],
  options: SendOptions,
): Promise<UploadReport> {
  const form = new FormData();
  for (const { file, path } of files) form.append("files", file, path);
  return sendForm<UploadReport>(`/datasets/${encodeURIComponent(slug)}/images`, form, options);
}

/** Posts a form to an API path; throws as `sendFiles` does. */
export function sendForm<T>(path: string, form: FormData, options: SendOptions): Promise<T> {
  const { onProgress, signal } = options;
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const abort = () => request.abort();
    if (signal.aborted) return reject(aborted());
    signal.addEventListener("abort", abort);
    request.upload.onprogress = (event) => {
      if (event.lengthComputable) onProgress(event.loaded, event.total);
    };
    request.onload = () => {
      const body = parsed(request.responseText);
      if (request.status >= 200 && request.status < 300) return resolve(body as T);
      reject(
        problemFrom(body, new Response(null, { status: request.status, statusText: request.statusText })),
      );
    };
    request.onerror = () => reject(unreachable());
    request.onabort = () => reject(aborted());
    request.onloadend = () => signal.removeEventListener("abort", abort);
    request.open("POST", apiUrl(path));
    for (const [name, value] of Object.entries(personHeaders())) request.setRequestHeader(name, value);
    request.send(form);
  });
}

function aborted(): DOMException {
  return new DOMException("The upload was cancelled", "AbortError");
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}
