import { describe, expect, it } from "vitest";
import { harmonicMean, isoF1, isoF1Levels } from "./iso_f1";

describe("iso-F1 curves", () => {
  it("have that F1 at every point and stay in the window", () => {
    for (const f1 of [0.1, 0.5, 0.9]) {
      const curve = isoF1(f1, [0, 1], [0, 1]);
      expect(curve.length).toBeGreaterThan(10);
      for (const [recall, precision] of curve) {
        expect(harmonicMean(recall, precision)).toBeCloseTo(f1, 9);
        expect(precision).toBeLessThanOrEqual(1 + 1e-9);
        expect(recall).toBeLessThanOrEqual(1);
      }
    }
  });

  it("reach the edges of the window", () => {
    const curve = isoF1(0.5, [0, 1], [0, 1]);
    expect(curve[0]?.[1]).toBeCloseTo(1, 9);
    expect(curve.at(-1)?.[0]).toBe(1);
  });

  it("leave a window at its bottom", () => {
    const curve = isoF1(0.5, [0.2, 1], [0.4, 0.8]);
    expect(curve[0]?.[1]).toBeCloseTo(0.8, 9);
    expect(curve.at(-1)?.[1]).toBeCloseTo(0.4, 9);
  });

  it("are empty outside the window", () => {
    expect(isoF1(0.2, [0.5, 1], [0.5, 1])).toEqual([]);
    expect(isoF1(0.9, [0, 0.4], [0, 0.4])).toEqual([]);
  });

  it("are drawn at round values between the window's corners", () => {
    expect(isoF1Levels([0, 1], [0, 1])).toEqual([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
    expect(isoF1Levels([0.6, 0.9], [0.6, 0.9])).toEqual([0.65, 0.7, 0.75, 0.8, 0.85]);
  });
});
