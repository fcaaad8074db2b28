import { describe, expect, it } from "vitest";
import { gridLines, type Lens, largestShift, readEstimate, undistort } from "./lens";

const lens: Lens = { width: 101, height: 101, center: [50, 50], scale: 50, k: [0.1, 0, 0], p: [0, 0] };

describe("undistort", () => {
  it("follows the formula", () => {
    expect(undistort(lens, [50, 50])).toEqual([50, 50]);
    expect(undistort(lens, [100, 50])).toEqual([50 + 50 * 1.1, 50]);
    const tangential = { ...lens, k: [], p: [0.01, 0.02] };
    // x = 1, y = 0.5, r2 = 1.25: dx = 2 p1 x y + p2 (r2 + 2 x2), dy = p1 (r2 + 2 y2) + 2 p2 x y
    const [x, y] = undistort(tangential, [100, 75]);
    expect(x).toBeCloseTo(100 + 50 * (0.01 + 0.02 * 3.25), 10);
    expect(y).toBeCloseTo(75 + 50 * (0.01 * 1.75 + 0.02), 10);
  });

  it("moves the corners the most", () => {
    expect(largestShift(lens)).toBeCloseTo(Math.hypot(50, 50) * 0.1 * 2, 10);
    expect(largestShift({ ...lens, k: [] })).toBe(0);
  });
});

it("covers the frame with the grid", () => {
  const lines = gridLines({ ...lens, width: 201 }, 10);
  expect(lines).toHaveLength(11 + 6);
  expect(lines.flat()).toContainEqual([200, 100]);
});

describe("readEstimate", () => {
  it("reads what the server gives", () => {
    const estimate = readEstimate({
      ...lens,
      accepted: false,
      reasons: ["not enough information"],
      uncertainty: { pred: 1.5, correction: null },
      counts: { trusted: 12 },
    });
    expect(estimate).toMatchObject({
      accepted: false,
      reasons: ["not enough information"],
      predictedError: 1.5,
      correction: null,
      trusted: 12,
    });
  });

  it("makes nothing of something else", () => {
    expect(readEstimate(null)).toBeNull();
    expect(readEstimate({ width: 3 })).toBeNull();
    expect(readEstimate({ ...lens, scale: 0 })).toBeNull();
  });
});
