import { describe, expect, it } from "vitest";
import { EMPTY_SCENE, makeScene } from "./scene";

/** Three horizontal lines at y = 0, 10 and 12, from x = 0 to 100. */
const scene = makeScene({
  revision: 1,
  ids: Uint32Array.of(11, 12, 13),
  offsets: Uint32Array.of(0, 3, 6, 9),
  coordinates: Float32Array.of(0, 0, 50, 0, 100, 0, 0, 10, 50, 10, 100, 10, 0, 12, 50, 12, 100, 12),
});
const all = () => true;

describe("pointing at candidates", () => {
  it("gives those within reach, nearest first", () => {
    expect(scene.near(30, 10.5, 3, all)).toEqual([
      { index: 1, distance: 0.5 },
      { index: 2, distance: 1.5 },
    ]);
  });

  it("measures to the line, not to its box", () => {
    const diagonal = makeScene({
      revision: 1,
      ids: Uint32Array.of(1),
      offsets: Uint32Array.of(0, 2),
      coordinates: Float32Array.of(0, 0, 100, 100),
    });
    expect(diagonal.near(90, 10, 5, all)).toEqual([]);
    expect(diagonal.near(51, 49, 5, all)).toHaveLength(1);
  });

  it("passes over hidden ones", () => {
    expect(scene.near(30, 10.5, 3, (index) => index !== 1).map((hit) => hit.index)).toEqual([2]);
  });

  it("finds nothing in an empty image", () => {
    expect(EMPTY_SCENE.near(0, 0, 1e9, all)).toEqual([]);
  });
});

describe("what lies in a box", () => {
  it.each([
    [{ minX: -1, minY: -1, maxX: 101, maxY: 11 }, [0, 1]],
    [{ minX: -1, minY: -1, maxX: 60, maxY: 5 }, [0]],
    [{ minX: 60, minY: -1, maxX: 200, maxY: 5 }, []],
  ])("is at least half inside: %o", (box, expected) => {
    expect(scene.inBox(box, all).sort()).toEqual(expected);
  });

  it("is passed over where it is hidden", () => {
    expect(scene.inBox({ minX: -1, minY: -1, maxX: 101, maxY: 11 }, (index) => index === 1)).toEqual([1]);
  });
});
