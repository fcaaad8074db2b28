import { describe, expect, it } from "vitest";
import { cellAt, cellEdges, cellIndex, roundFactor } from "./frame_cells";

describe("cells of a frame", () => {
  const x = cellEdges([1.5, 5.5, 9.5], 12);
  const y = cellEdges([2, 7], 10);

  it("end halfway between their middles, and with the frame", () => {
    expect(x).toEqual([-0.5, 3.5, 7.5, 11.5]);
    expect(cellAt(x, y, 2, 1)).toEqual({ left: 7.5, top: 4.5, width: 4, height: 5 });
  });

  it("are found by any position, the outermost ones from outside too", () => {
    expect([-20, -0.5, 3.4, 3.5, 11, 40].map((place) => cellIndex(x, place))).toEqual([0, 0, 0, 1, 2, 2]);
  });

  it("cover the frame where there is but one", () => {
    expect(cellEdges([4.5], 10)).toEqual([-0.5, 9.5]);
  });
});

it("enlarges arrows by a round factor, never beyond what was asked for", () => {
  expect([0.7, 1, 4.9, 27, 100, 0, Number.NaN].map(roundFactor)).toEqual([0.5, 1, 2, 20, 100, 1, 1]);
});
