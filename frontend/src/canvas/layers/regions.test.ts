import { describe, expect, it } from "vitest";
import { makeScene } from "../scene";
import { boxesAlong, canvasBox, imageBox } from "./regions";

const viewport = { scale: 2.5, offsetX: -31, offsetY: 17 };

describe("boxes", () => {
  it("lie on whole canvas px and leave room for the line's width", () => {
    const box = canvasBox({ minX: 10, minY: 20, maxX: 30, maxY: 25 }, viewport, 2, 40);
    for (const value of Object.values(box)) expect(Number.isInteger(value)).toBe(true);
    expect(box.minX).toBeLessThanOrEqual((10.5 * 2.5 - 31) * 2 + 40 - 2 * 2.6);
    expect(box.maxX).toBeGreaterThanOrEqual((30.5 * 2.5 - 31) * 2 + 40 + 2 * 2.6);
  });

  it("come back from the canvas at least as large", () => {
    const box = { minX: 10, minY: 20, maxX: 30, maxY: 25 };
    const back = imageBox(canvasBox(box, viewport, 2, 40), viewport, 2, 40);
    expect(back.minX).toBeLessThan(box.minX);
    expect(back.maxY).toBeGreaterThan(box.maxY);
  });

  it("along a diagonal cover every point with a small part of its box", () => {
    const points = 300;
    const coordinates = Float32Array.from({ length: 2 * points }, (_, i) => Math.floor(i / 2));
    const scene = makeScene({
      revision: 1,
      ids: Uint32Array.of(1),
      offsets: Uint32Array.of(0, points),
      coordinates,
    });
    const boxes = boxesAlong(scene, 0);
    const area = boxes.reduce((sum, b) => sum + (b.maxX - b.minX) * (b.maxY - b.minY), 0);
    expect(area).toBeLessThan(0.15 * 299 * 299);
    for (let i = 0; i < points; i++) expect(boxes.some((b) => b.minX <= i && i <= b.maxX)).toBe(true);
  });
});
