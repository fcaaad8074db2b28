/** The candidates of an image with their points, fetched together and brought into one order. */

import { getPoints, getSegments } from "../api/endpoints";
import type { ImageSegments, SegmentFacts } from "../api/types";
import { decodePolylines } from "../canvas/decode";
import { makeScene, type Scene } from "../canvas/scene";
import { KnownScenes } from "./known_scenes";

export interface Annotations {
  readonly imageId: number;
  readonly imageWidth: number;
  readonly imageHeight: number;
  /** In the order of the scene's polylines. */
  readonly candidates: readonly SegmentFacts[];
  readonly scene: Scene;
  /** The image's last decision that the candidates' verdicts follow. */
  readonly lastDecisionId: number;
}

/** Where annotations come from. */
interface Sources {
  segments: (imageId: number) => Promise<ImageSegments>;
  scene: (imageId: number) => Promise<Scene>;
  known: KnownScenes;
}

/** A run that finishes between two requests changes the revision; then both are asked for again. */
const ATTEMPTS = 3;

const SERVER: Sources = {
  segments: getSegments,
  scene: async (imageId) => makeScene(decodePolylines(await getPoints(imageId))),
  known: new KnownScenes(),
};

export async function loadAnnotations(imageId: number, sources: Sources = SERVER): Promise<Annotations> {
  const { known } = sources;
  for (let attempt = 1; ; attempt++) {
    const before = known.get(imageId);
    const [segments, scene] = await Promise.all([
      sources.segments(imageId),
      before ?? sources.scene(imageId),
    ]);
    const candidates = inOrderOf(scene, segments);
    if (candidates !== null) {
      known.keep(imageId, scene);
      const { image_id, width, height, last_decision_id } = segments;
      return {
        imageId: image_id,
        imageWidth: width,
        imageHeight: height,
        candidates,
        scene,
        lastDecisionId: last_decision_id,
      };
    }
    known.forget(imageId);
    if (attempt === ATTEMPTS) throw new Error("The candidates keep changing; a run may be going on.");
  }
}

/** The candidates in the order of the scene's polylines; null where they aren't those of the scene. */
function inOrderOf({ polylines }: Scene, { revision, segments }: ImageSegments): SegmentFacts[] | null {
  if (polylines.revision !== revision || polylines.ids.length !== segments.length) return null;
  const facts = new Map(segments.map((segment) => [segment.id, segment]));
  const candidates: SegmentFacts[] = [];
  for (const id of polylines.ids) {
    const found = facts.get(id);
    if (found === undefined) return null;
    candidates.push(found);
  }
  return candidates;
}
