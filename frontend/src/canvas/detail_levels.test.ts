import { describe, expect, it } from "vitest";
import { makeDetailLevels } from "./detail_levels";

const polylines = {
  revision: 1,
  ids: Uint32Array.of(1, 2),
  offsets: Uint32Array.of(0, 3, 6),
  // The first one's middle is 0.2 px off, the second one is straight.
  coordinates: Float32Array.of(0, 0, 50, 0.2, 100, 0, 0, 10, 50, 10, 100, 10),
};

const levels = () => makeDetailLevels(polylines);

describe("levels of detail", () => {
  it("are made twice per power of two", () => {
    const line = levels();
    expect(line(0, 1.5)).toBe(line(0, 1.9));
    expect(line(0, 1.3)).not.toBe(line(0, 1.5));
    expect(line(0, 1.9)).not.toBe(line(0, 2.1));
  });

  it("have each polyline with its ends, and what is seen between them", () => {
    const line = levels();
    expect([...line(0, 1)]).toEqual([0, 0, 100, 0]);
    expect([...line(0, 2)]).toEqual([0, 0, 50, Math.fround(0.2), 100, 0]);
    expect([...line(1, 64)]).toEqual([0, 10, 100, 10]);
  });

  it("are forgotten beyond a few", () => {
    const line = levels();
    const first = line(0, 1);
    for (let zoom = 1; zoom <= 5; zoom++) line(0, 2 ** zoom);
    expect(line(0, 1)).toBe(first);
    line(0, 64);
    expect(line(0, 1)).not.toBe(first);
  });
});
