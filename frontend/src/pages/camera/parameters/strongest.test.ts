import { expect, it } from "vitest";
import { strongest } from "./strongest";

it("finds the pair of parameters that are told apart worst, whatever the sign", () => {
  const correlation = [
    [1, -0.97, 0.1],
    [-0.97, 1, 0.4],
    [0.1, 0.4, 1],
  ];
  expect(strongest(["k1", "k2", "cx"], correlation)).toEqual({ first: "k1", second: "k2", value: -0.97 });
  expect(strongest(["k1"], [[1]])).toBeNull();
});
