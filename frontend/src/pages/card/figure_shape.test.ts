import { describe, expect, it } from "vitest";
import { figureShape } from "./figure_shape";

describe("the place of the figure", () => {
  it("holds three panels side by side", () => {
    expect(figureShape("1200 x 800")).toBe(4.5);
  });

  it("holds wide ones below each other", () => {
    expect(figureShape("1200 x 400")).toBe(1);
  });

  it("is there where no size is known", () => {
    expect(figureShape(undefined)).toBe(4);
    expect(figureShape("many")).toBe(4);
  });
});
