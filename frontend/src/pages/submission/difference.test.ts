import { expect, it } from "vitest";
import { turned } from "./difference";

it("turns a difference round with its interval", () => {
  expect(turned({ a: 0.5, b: 0.6, difference: 0.1, low: 0.05, high: 0.2, tied: false })).toEqual({
    a: 0.5,
    b: 0.6,
    difference: -0.1,
    low: -0.2,
    high: -0.05,
    tied: false,
  });
});

it("leaves nothing nothing", () => {
  const same = { a: 1, b: 1, difference: 0, low: null, high: null, tied: true };
  expect(turned(same)).toEqual(same);
});
