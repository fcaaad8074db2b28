import { describe, expect, it } from "vitest";
import { distanceToPolyline } from "./geometry";
import { polygonContains, shareInside, squaredGap, strokeTouches } from "./touching";

const corner = Float32Array.of(0, 0, 10, 0, 10, 10);
const touches = (from: [number, number], to: [number, number], radius: number, first = 0, end = 3) =>
  strokeTouches(corner, first, end, { x: from[0], y: from[1] }, { x: to[0], y: to[1] }, radius);

/** Numbers between 0 and 1 that are the same in every run. */
function numbersFrom(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return state / 2 ** 32;
  };
}

describe("a stroke", () => {
  it("touches what it crosses, however thin it is", () => {
    expect(touches([5, -5], [5, 5], 0)).toBe(true);
    expect(touches([12, 5], [8, 5], 0)).toBe(true);
  });

  it("touches what lies beside it within its radius, and nothing farther", () => {
    expect(touches([0, -3], [10, -3], 3)).toBe(true);
    expect(touches([0, -3], [10, -3], 2.999)).toBe(false);
  });

  it("has round ends", () => {
    expect(touches([-7, -4], [-3, -4], 5)).toBe(true);
    expect(touches([-7, -4], [-3, -4], 4.99)).toBe(false);
  });

  it("of no length is a disc", () => {
    expect(touches([13, 14], [13, 14], 5)).toBe(true);
    expect(touches([13, 14], [13, 14], 4.9)).toBe(false);
  });

  it("looks only at the points it is given", () => {
    expect(touches([10, 8], [12, 8], 1, 0, 2)).toBe(false);
    expect(touches([10, 8], [12, 8], 2, 2, 3)).toBe(true);
    expect(touches([0, 0], [4, 0], 1, 2, 3)).toBe(false);
  });

  it("lying on a line, or touching its end, is at distance 0", () => {
    expect(squaredGap(0, 0, 4, 0, 2, 0, 8, 0)).toBe(0);
    expect(squaredGap(0, 0, 4, 0, 4, 0, 4, 9)).toBe(0);
    expect(squaredGap(0, 0, 4, 0, 7, 4, 9, 4)).toBe(25);
  });

  it("touches exactly what a densely sampled one comes close to", () => {
    const next = numbersFrom(7);
    for (let round = 0; round < 400; round++) {
      const line = Float32Array.from({ length: 2 * (2 + Math.floor(5 * next())) }, () => 100 * next());
      const [from, to] = [0, 1].map(() => ({ x: 100 * next(), y: 100 * next() })) as [never, never];
      const radius = 15 * next();
      const steps = Array.from({ length: 801 }, (_, i) => i / 800);
      const nearest = Math.min(
        ...steps.map((t) =>
          distanceToPolyline(line, 0, line.length / 2, mix(from, to, "x", t), mix(from, to, "y", t)),
        ),
      );
      // Between two samples, less than 0.18 px apart, the stroke may come closer by half of that.
      if (Math.abs(nearest - radius) < 0.1) continue;
      expect(strokeTouches(line, 0, line.length / 2, from, to, radius)).toBe(nearest < radius);
    }
  });
});

function mix(a: { x: number; y: number }, b: { x: number; y: number }, axis: "x" | "y", t: number): number {
  return a[axis] * (1 - t) + b[axis] * t;
}

describe("a lasso", () => {
  const square = [
    { x: -1, y: -1 },
    { x: 11, y: -1 },
    { x: 11, y: 5 },
    { x: -1, y: 5 },
  ];

  it("contains what it goes around, in whichever direction it was drawn", () => {
    for (const polygon of [square, [...square].reverse()]) {
      expect(polygonContains(polygon, 0, 0)).toBe(true);
      expect(polygonContains(polygon, 0, 6)).toBe(false);
      expect(polygonContains(polygon, -2, 0)).toBe(false);
    }
  });

  it("of fewer than three corners contains nothing", () => {
    expect(polygonContains([], 0, 0)).toBe(false);
    expect(polygonContains(square.slice(0, 2), 5, -1)).toBe(false);
  });

  it("tells how much of a line is inside", () => {
    expect(shareInside(corner, 0, 2, square)).toBe(1);
    expect(shareInside(corner, 1, 3, square)).toBe(0.5);
    expect(shareInside(corner, 0, 3, square)).toBe(0.75);
  });

  it("takes a single point for a line", () => {
    expect(shareInside(corner, 0, 1, square)).toBe(1);
    expect(shareInside(corner, 2, 3, square)).toBe(0);
  });
});
