import { describe, expect, it } from "vitest";
import { withClick } from "./clicks";

const at = (x: number, y = 0) => ({ x, y });

describe("clicked points", () => {
  it("stand in the order of the edge, wherever they were clicked", () => {
    const clicks = [at(10), at(110)].reduce(withClick, []);
    expect(withClick(clicks, at(60, 4)).map(({ x }) => x)).toEqual([10, 60, 110]);
    expect(withClick(clicks, at(0)).map(({ x }) => x)).toEqual([0, 10, 110]);
    expect(withClick(clicks, at(150, -9)).map(({ x }) => x)).toEqual([10, 110, 150]);
  });

  it("keep the order of clicking where the edge runs backwards", () => {
    const clicks = [at(110), at(10)].reduce(withClick, []);
    expect(withClick(clicks, at(60)).map(({ x }) => x)).toEqual([110, 60, 10]);
  });
});
