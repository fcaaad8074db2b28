import { expect, it } from "vitest";
import { readReference } from "./reference_text";

it("names what a reference holds, and leaves out what it doesn't", () => {
  const K = [
    [980.12, 0, 690.04],
    [0, 975.9, 249.5],
    [0, 0, 1],
  ];
  expect(readReference({ width: 1392, height: 512, K, D: [-0.37, 0.2] })).toEqual([
    ["Size", "1392 × 512 px"],
    ["Focal length", "980.1, 975.9 px"],
    ["Principal point", "690.0, 249.5 px"],
    ["k1", "−0.37000"],
    ["k2", "0.20000"],
  ]);
  expect(readReference({ K: null, D: "none" })).toEqual([]);
});
