import { describe, expect, it } from "vitest";
import { commonAspect, gridHeight, gridLayout, tileAfterKey, tilePlace, tilesInView } from "./grid_layout";

const layout = gridLayout(1_000, "small", 2);
const row = layout.tileHeight + layout.gap;

describe("the grid", () => {
  it("fills the width with whole columns", () => {
    expect(layout.columns).toBe(5);
    expect(layout.columns * layout.tileWidth + (layout.columns - 1) * layout.gap).toBeCloseTo(1_000);
    expect(gridLayout(100, "large", 1).columns).toBe(1);
  });

  it("is as high as its rows, loaded or not", () => {
    expect(gridHeight(layout, 0)).toBe(0);
    expect(gridHeight(layout, 5)).toBe(layout.tileHeight);
    expect(gridHeight(layout, 6)).toBe(row + layout.tileHeight);
  });

  it("places tiles row by row", () => {
    expect(tilePlace(layout, 6)).toEqual({ left: layout.tileWidth + layout.gap, top: row });
  });

  it("keeps to what is in view", () => {
    expect(tilesInView(layout, 10_000, 0, 2 * row, 0)).toEqual({ first: 0, end: 10 });
    expect(tilesInView(layout, 10_000, 100 * row, 2 * row, 1)).toEqual({ first: 495, end: 515 });
    expect(tilesInView(layout, 12, 0, 100 * row)).toEqual({ first: 0, end: 12 });
    expect(tilesInView(layout, 12, 1e6, 500)).toEqual({ first: 12, end: 12 });
    expect(tilesInView(layout, 12, -1e6, 500)).toEqual({ first: 0, end: 0 });
  });
});

describe("arrow keys", () => {
  it("stay within the images", () => {
    expect(tileAfterKey("ArrowRight", 3, 5, 12)).toBe(4);
    expect(tileAfterKey("ArrowDown", 3, 5, 12)).toBe(8);
    expect(tileAfterKey("ArrowDown", 9, 5, 12)).toBe(11);
    expect(tileAfterKey("ArrowUp", 3, 5, 12)).toBe(0);
    expect(tileAfterKey("Home", 7, 5, 12)).toBe(0);
    expect(tileAfterKey("End", 7, 5, 12)).toBe(11);
    expect(tileAfterKey("k", 7, 5, 12)).toBeNull();
    expect(tileAfterKey("End", 0, 5, 0)).toBeNull();
  });
});

describe("the shape of the pictures", () => {
  it("is that of the middle image, within bounds", () => {
    const sized = (...aspects: number[]) => aspects.map((aspect) => ({ width: 100 * aspect, height: 100 }));
    expect(commonAspect(sized(1.5, 2, 1.4))).toBe(1.5);
    expect(commonAspect(sized(9))).toBe(2.4);
    expect(commonAspect(sized(0.1))).toBe(1.25);
    expect(commonAspect([])).toBeCloseTo(4 / 3);
  });
});
