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

describe("levels of detail", () => {
  it("are made twice per power of two", () => {
    expect(scene.atScale(1.5)).toBe(scene.atScale(1.9));
    expect(scene.atScale(1.3)).not.toBe(scene.atScale(1.5));
    expect(scene.atScale(1.9)).not.toBe(scene.atScale(2.1));
  });

  it("have each polyline with its ends", () => {
    const { offsets, coordinates } = scene.atScale(0.5);
    expect([...offsets]).toEqual([0, 2, 4, 6]);
    expect([...coordinates.slice(0, 4)]).toEqual([0, 0, 100, 0]);
  });
});
