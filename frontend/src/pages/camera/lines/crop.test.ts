import { describe, expect, it } from "vitest";
import { cropAround } from "./crop";

const IMAGE = { width: 1000, height: 700 };

describe("cropAround", () => {
  it("holds a line of any direction, in one shape", () => {
    expect(cropAround([100, 250, 500, 254], IMAGE)).toEqual({ x: 40, y: 89.5, width: 520, height: 325 });
    const upright = cropAround([500, 100, 504, 420], IMAGE);
    expect(upright.height).toBeCloseTo(416);
    expect(upright.width / upright.height).toBeCloseTo(1.6);
    expect(upright.x + upright.width / 2).toBeCloseTo(502);
  });

  it("stays in the image where it fits", () => {
    const corner = cropAround([0, 690, 60, 699], IMAGE);
    expect(corner.x).toBe(0);
    expect(corner.y + corner.height).toBeCloseTo(700);
    const whole = cropAround([0, 0, 999, 699], IMAGE);
    expect(whole.x + whole.width / 2).toBeCloseTo(500);
  });

  it("shows enough around a tiny line", () => {
    expect(cropAround([10, 10, 11, 11], IMAGE).width).toBe(60);
  });
});
