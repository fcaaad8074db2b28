import { describe, expect, it } from "vitest";
import { COLOURS, colourOf, levelsOf } from "./map_levels";

describe("levelsOf", () => {
  it("cuts evenly at round numbers", () => {
    const levels = levelsOf([0, 1.2, 3.9], "even", 6);
    expect(levels.breaks).toEqual([1, 2, 3]);
    expect([0, 0.99, 1, 3.9].map(levels.of)).toEqual([0, 0, 1, 3]);
  });

  it("cuts as finely as there are colours where values lie decades apart", () => {
    expect(levelsOf([0.018, 0.04, 0.29], "decades").breaks).toEqual([0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2]);
    expect(levelsOf([0.04, 0.3, 2.4], "decades").breaks).toEqual([0.05, 0.1, 0.2, 0.5, 1, 2]);
    expect(levelsOf([0.04, 100], "decades").breaks).toEqual([0.1, 0.3, 1, 3, 10, 30, 100]);
  });

  it("leaves the lowest steps together where there are more than colours", () => {
    const { breaks } = levelsOf([1e-6, 1e3], "decades");
    expect(breaks).toHaveLength(COLOURS - 1);
    expect(breaks.at(-1)).toBe(1000);
    expect(breaks[0]).toBe(1e-4);
  });

  it("has one level where there is nothing, or what isn't a number", () => {
    for (const values of [[], [0, 0], [Number.NaN, 0]]) {
      const levels = levelsOf(values, "decades");
      expect(levels.breaks).toEqual([]);
      expect(colourOf(levels.of(0), levels)).toBe(0);
    }
  });
});

describe("colourOf", () => {
  it("uses the first and the last colour whatever the number of levels", () => {
    const levels = levelsOf([0.9, 3], "decades", 4);
    expect(levels.breaks).toEqual([1, 2]);
    expect([0, 1, 2].map((level) => colourOf(level, levels))).toEqual([0, 4, COLOURS - 1]);
  });
});
