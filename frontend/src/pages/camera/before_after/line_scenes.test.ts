import { expect, it } from "vitest";
import { lineScenes } from "./line_scenes";

it("packs the lines of both sides under the same indices", () => {
  const scenes = lineScenes([
    {
      segment_id: 40,
      rms: 0.1,
      probability: 1,
      measured: [
        [0, 0],
        [10, 2],
        [20, 0],
      ],
      undistorted: [
        [0, 0],
        [20, 0],
      ],
    },
    { segment_id: 41, rms: null, probability: 1, measured: [[5, 50]], undistorted: [] },
  ]);
  expect([...scenes.before.polylines.offsets]).toEqual([0, 3, 4]);
  expect([...scenes.after.polylines.offsets]).toEqual([0, 2, 2]);
  expect([...scenes.after.polylines.ids]).toEqual([40, 41]);
  expect(scenes.before.near(10, 3, 2, () => true).map(({ index }) => index)).toEqual([0]);
  expect(scenes.after.near(10, 3, 2, () => true)).toEqual([]);
});
