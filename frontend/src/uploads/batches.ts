/** Which files share a request: few requests for many small files, and a request never too long. */

import { kindOf, pairKey } from "./file_kinds";

export interface BatchLimits {
  files: number;
  bytes: number;
  /** A dataset folder with tables goes as a whole up to this size. */
  wholeBytes: number;
}

interface Sized {
  path: string;
  size: number;
}

/**
 * Files in the order given, cut into batches.
 *
 * A zip goes alone. An image and its labels go together, since labels are found by the image's name. `images.csv` and
 * `cameras.json` speak of the images around them, so files with such a table go as one dataset where they aren't too
 * large for that. A file larger than `limits.bytes` goes alone.
 */
export function makeBatches<T extends Sized>(files: readonly T[], limits: BatchLimits): T[][] {
  const zips = files.filter((file) => kindOf(file.path) === "zip").map((file) => [file]);
  const loose = files.filter((file) => kindOf(file.path) !== "zip");
  const hasTable = loose.some((file) => kindOf(file.path) === "table");
  if (hasTable && sizeOf(loose) <= limits.wholeBytes) return [loose, ...zips];
  return [...cut(pairs(loose), limits), ...zips];
}

function pairs<T extends Sized>(files: readonly T[]): T[][] {
  const groups = new Map<string, T[]>();
  for (const file of files) {
    const key = kindOf(file.path) === "other" ? file.path : pairKey(file.path);
    const group = groups.get(key);
    if (group) group.push(file);
    else groups.set(key, [file]);
  }
  return [...groups.values()];
}

function cut<T extends Sized>(groups: readonly T[][], limits: BatchLimits): T[][] {
  const batches: T[][] = [];
  let batch: T[] = [];
  for (const group of groups) {
    const full = batch.length + group.length > limits.files || sizeOf(batch) + sizeOf(group) > limits.bytes;
    if (full && batch.length > 0) {
      batches.push(batch);
      batch = [];
    }
    batch.push(...group);
  }
  if (batch.length > 0) batches.push(batch);
  return batches;
}

function sizeOf(files: readonly Sized[]): number {
  return files.reduce((sum, file) => sum + file.size, 0);
}
