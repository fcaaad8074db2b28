import { expect, it } from "vitest";
import { around } from "./around";

it("shows as many as there is room for, with the current one in the middle where it can be", () => {
  expect(around(5000, 15, 10_000)).toEqual([4993, 5008]);
  expect(around(1, 15, 10_000)).toEqual([0, 15]);
  expect(around(9_999, 15, 10_000)).toEqual([9_985, 10_000]);
  expect(around(2, 15, 4)).toEqual([0, 4]);
  expect(around(0, 15, 0)).toEqual([0, 0]);
});
