/** The candidates of an image with their points, fetched together and brought into one order. */

import { getPoints, getSegments } from "../api/endpoints";
import type { ImageSegments, SegmentFacts } from "../api/types";
import { decodePolylines, type Polylines } from "../canvas/decode";
import { makeScene, type Scene } from "../canvas/scene";

export interface Annotations {
  readonly imageId: number;
  readonly imageHeight: number;
  /** In the order of the scene's polylines. */
  readonly candidates: readonly SegmentFacts[];
  readonly scene: Scene;
}

/** A run that finishes between two requests changes the revision; then both are asked for again. */
const ATTEMPTS = 3;

export async function loadAnnotations(imageId: number): Promise<Annotations> {
  for (let attempt = 1; ; attempt++) {
    const [segments, bytes] = await Promise.all([getSegments(imageId), getPoints(imageId)]);
    const polylines = decodePolylines(bytes);
    if (polylines.revision === segments.revision) return joined(segments, polylines);
    if (attempt === ATTEMPTS) throw new Error("The candidates keep changing; a run may be going on.");
  }
}

function joined(segments: ImageSegments, polylines: Polylines): Annotations {
  const facts = new Map(segments.segments.map((segment) => [segment.id, segment]));
  const candidates = Array.from(polylines.ids, (id) => {
    const found = facts.get(id);
    if (found === undefined) throw new Error(`Segment ${id} has points but no facts.`);
    return found;
  });
  return {
    imageId: segments.image_id,
    imageHeight: segments.height,
    candidates,
    scene: makeScene(polylines),
  };
}
