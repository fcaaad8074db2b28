import { describe, expect, it } from "vitest";
import { selectPolylines } from "./select_polylines";

const THREE = {
  revision: 4,
  ids: Uint32Array.of(7, 8, 9),
  offsets: Uint32Array.of(0, 2, 5, 7),
  coordinates: Float32Array.from({ length: 14 }, (_, at) => at),
};

describe("selected polylines", () => {
  it("have the points that they had, in their order", () => {
    expect(selectPolylines(THREE, new Set([9, 7]))).toEqual({
      revision: 4,
      ids: Uint32Array.of(7, 9),
      offsets: Uint32Array.of(0, 2, 4),
      coordinates: Float32Array.of(0, 1, 2, 3, 10, 11, 12, 13),
    });
  });

  it("may be none", () => {
    const none = selectPolylines(THREE, new Set([1]));
    expect([none.ids.length, none.offsets, none.coordinates.length]).toEqual([0, Uint32Array.of(0), 0]);
  });
});
