import { describe, expect, it } from "vitest";
import { digits, px, withSigma } from "./length_text";

describe("lengths", () => {
  it("have about three digits", () => {
    expect([0.0421, 0.4242, 9.99, 12.34, 311.6].map(px)).toEqual([
      "0.042 px",
      "0.42 px",
      "9.99 px",
      "12.3 px",
      "312 px",
    ]);
  });

  it("that aren't known are said so", () => {
    expect([null, undefined, Number.NaN].map(px)).toEqual(["not known", "not known", "not known"]);
  });

  it("have a true minus sign, and none at nothing", () => {
    expect(digits(-0.5)).toBe("−0.50");
    expect(digits(-0.0001)).toBe("0.000");
  });
});

it("leaves a value the digits that its uncertainty leaves standing", () => {
  expect(withSigma(-0.371234, 0.00081)).toBe("−0.37123 ± 0.00081");
  expect(withSigma(621.37, 3.2)).toBe("621.4 ± 3.2");
  expect(withSigma(0.25, undefined)).toBe("0.2500");
});
