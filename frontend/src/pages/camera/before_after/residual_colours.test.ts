import { expect, it } from "vitest";
import { RESIDUAL_COLOURS, residualScale } from "./residual_colours";

it("gives lines that are as straight as the noise allows the first colour, and bent ones the last", () => {
  const scale = residualScale(0.124);
  expect(scale.limits).toEqual([0.12, 0.19, 0.31, 0.5]);
  expect([0, 0.12, 0.2, 0.4, 0.5, 9].map(scale.colourOf)).toEqual([
    RESIDUAL_COLOURS[0],
    RESIDUAL_COLOURS[1],
    RESIDUAL_COLOURS[2],
    RESIDUAL_COLOURS[3],
    RESIDUAL_COLOURS[4],
    RESIDUAL_COLOURS[4],
  ]);
});
