import { describe, expect, it } from "vitest";
import { between, eased } from "./glide";
import { toImage } from "./viewport";

const screen = { width: 1000, height: 800 };
const from = { scale: 1, offsetX: 0, offsetY: 0 };
const to = { scale: 4, offsetX: -2000, offsetY: -900 };

describe("a gliding view", () => {
  it("begins and ends where it should", () => {
    const start = between(from, to, 0, screen);
    expect(start.scale).toBeCloseTo(from.scale, 12);
    expect(start.offsetX).toBeCloseTo(from.offsetX, 9);
    expect(between(from, to, 1, screen)).toBe(to);
  });

  it("moves its middle along a straight way", () => {
    const middle = toImage(between(from, to, 0.5, screen), 500, 400);
    const a = toImage(from, 500, 400);
    const b = toImage(to, 500, 400);
    expect(middle.x).toBeCloseTo((a.x + b.x) / 2, 9);
    expect(middle.y).toBeCloseTo((a.y + b.y) / 2, 9);
  });

  it("slows down towards its end and never leaves the way", () => {
    expect(eased(0.5)).toBeGreaterThan(0.5);
    expect([eased(-1), eased(0), eased(1), eased(2)]).toEqual([0, 0, 1, 1]);
  });
});
