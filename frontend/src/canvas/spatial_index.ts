import Flatbush from "flatbush";
import type { Box } from "./geometry";

/** Finds boxes by place. Answers are indices into the boxes it was made of. */
export interface SpatialIndex {
  /** All boxes that touch the given one, in no particular order. */
  touching(box: Box, accept?: (index: number) => boolean): number[];
}

const NOTHING: SpatialIndex = { touching: () => [] };

export function makeSpatialIndex(boxes: readonly Box[]): SpatialIndex {
  // Flatbush refuses to index nothing.
  if (boxes.length === 0) return NOTHING;
  const tree = new Flatbush(boxes.length, 16, Float32Array);
  for (const { minX, minY, maxX, maxY } of boxes) tree.add(minX, minY, maxX, maxY);
  tree.finish();
  return {
    touching: ({ minX, minY, maxX, maxY }, accept) => tree.search(minX, minY, maxX, maxY, accept),
  };
}
