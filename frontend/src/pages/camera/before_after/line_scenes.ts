/** The lines of an image as scenes that can be drawn and pointed at. */

import type { ImageLine } from "../../../api/camera_types";
import type { Polylines } from "../../../canvas/decode";
import { makeScene, type Scene } from "../../../canvas/scene";

export interface LineScenes {
  readonly before: Scene;
  readonly after: Scene;
}

export function lineScenes(lines: readonly ImageLine[]): LineScenes {
  return {
    before: makeScene(packed(lines, ({ measured }) => measured)),
    after: makeScene(packed(lines, ({ undistorted }) => undistorted)),
  };
}

type Points = readonly (readonly [number, number])[];

function packed(lines: readonly ImageLine[], pointsOf: (line: ImageLine) => Points): Polylines {
  const offsets = new Uint32Array(lines.length + 1);
  lines.forEach((line, index) => {
    offsets[index + 1] = (offsets[index] ?? 0) + pointsOf(line).length;
  });
  return {
    revision: 0,
    ids: Uint32Array.from(lines, ({ segment_id }) => segment_id),
    offsets,
    coordinates: Float32Array.from(lines.flatMap((line) => pointsOf(line).flat())),
  };
}
