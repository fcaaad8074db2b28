import { expect, it } from "vitest";
import { comparedParameters } from "./compared";

function lens(family: "brown" | "division", parameters: number[], sigma: Record<string, number>) {
  return { lens: { family, names: ["k1", "k2", "k3"], parameters }, released: Object.keys(sigma), sigma };
}

it("tells how far apart two calibrations are in their own uncertainty", () => {
  const before = lens("brown", [0.3, 0.1, 0], { k1: 0.03, k2: 0.5 });
  const after = lens("brown", [0.35, 0, 0], { k1: 0.04 });
  const [k1, k2, ...others] = comparedParameters(before, after);
  expect(k1?.sigmas).toBeCloseTo(1);
  expect(k2).toEqual({ name: "k2", first: { value: 0.1, sigma: 0.5 }, second: null, sigmas: null });
  expect(others).toEqual([]);
});

it("compares no parameters of different models, which mean different things", () => {
  expect(
    comparedParameters(lens("brown", [1, 0, 0], { k1: 1 }), lens("division", [1, 0, 0], { k1: 1 })),
  ).toEqual([]);
});
