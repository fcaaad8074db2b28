import { describe, expect, it } from "vitest";
import { fitted, keepInReach, pan, toImage, toScreen, visibleBox, zoomAt } from "./viewport";

const viewport = { scale: 4, offsetX: 10, offsetY: 20 };

describe("image and screen", () => {
  it("draws the centre of pixel (x, y) at (x + .5, y + .5) image px", () => {
    expect(toScreen({ scale: 1, offsetX: 0, offsetY: 0 }, 0, 0)).toEqual({ x: 0.5, y: 0.5 });
    expect(toScreen(viewport, 3, 7)).toEqual({ x: 3.5 * 4 + 10, y: 7.5 * 4 + 20 });
  });

  it("are inverse to each other", () => {
    const { x, y } = toScreen(viewport, 12.25, -3.5);
    expect(toImage(viewport, x, y)).toEqual({ x: 12.25, y: -3.5 });
  });
});

describe("zoom", () => {
  it("leaves the image where it is under the pointer", () => {
    const pointer = { x: 123, y: 45 };
    const before = toImage(viewport, pointer.x, pointer.y);
    const after = toImage(zoomAt(viewport, pointer, 1.7, 0.1), pointer.x, pointer.y);
    expect(after.x).toBeCloseTo(before.x, 9);
    expect(after.y).toBeCloseTo(before.y, 9);
  });

  it("stops at its limits without moving the image", () => {
    const smallest = zoomAt(viewport, { x: 50, y: 50 }, 1e-6, 0.5);
    expect(smallest.scale).toBe(0.5);
    expect(zoomAt(smallest, { x: 0, y: 0 }, 0.1, 0.5)).toEqual(smallest);
    expect(zoomAt(viewport, { x: 0, y: 0 }, 1e9, 0.5).scale).toBe(64);
  });
});

describe("fit", () => {
  it("shows the whole image in the middle", () => {
    const screen = { width: 1024, height: 524 };
    const view = fitted({ width: 2000, height: 1000 }, screen);
    expect(view.scale).toBe(0.5);
    expect(toScreen(view, 1000 - 0.5, 500 - 0.5)).toEqual({ x: 512, y: 262 });
  });
});

describe("reach", () => {
  it("never lets the image go altogether", () => {
    const image = { width: 100, height: 100 };
    const screen = { width: 400, height: 300 };
    const far = keepInReach(pan({ scale: 2, offsetX: 0, offsetY: 0 }, 1e6, -1e6), image, screen);
    expect(far.offsetX).toBe(300);
    expect(far.offsetY).toBe(-100);
  });

  it("leaves a view alone that shows enough", () => {
    const view = { scale: 2, offsetX: 30, offsetY: 40 };
    expect(keepInReach(view, { width: 100, height: 100 }, { width: 400, height: 300 })).toEqual(view);
  });
});

describe("visible box", () => {
  it("goes from corner to corner of the screen", () => {
    expect(visibleBox({ scale: 2, offsetX: 0, offsetY: -20 }, { width: 200, height: 100 })).toEqual({
      minX: -0.5,
      minY: 9.5,
      maxX: 99.5,
      maxY: 59.5,
    });
  });
});
