import { describe, expect, it } from "vitest";
import { fittedDomain, linearScale, ticks } from "./scale";

describe("linear scale", () => {
  it("maps the ends of the domain to the ends of the range, also downwards", () => {
    const scale = linearScale([0.5, 1], [100, 0]);
    expect([scale.at(0.5), scale.at(0.75), scale.at(1)]).toEqual([100, 50, 0]);
  });

  it("puts everything in the middle of a domain without extent", () => {
    expect(linearScale([3, 3], [0, 10]).at(3)).toBe(5);
  });
});

describe("ticks", () => {
  it("are round, inside the domain and free of rounding errors", () => {
    expect(ticks([0, 1], 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
    expect(ticks([0.15, 0.52], 4)).toEqual([0.2, 0.3, 0.4, 0.5]);
    expect(ticks([0, 37], 4)).toEqual([0, 10, 20, 30]);
  });

  it("of an empty domain are its one value", () => {
    expect(ticks([2, 2], 5)).toEqual([2]);
  });
});

describe("fitted domain", () => {
  const shares = { step: 0.1, width: 0.3, limits: [0, 1] as const };

  it("ends on steps around the values", () => {
    expect(fittedDomain([0.24, 0.66], shares)).toEqual([0.2, 0.7]);
  });

  it("leaves room beside values that lie on a step", () => {
    expect(fittedDomain([0.2, 0.7], shares)).toEqual([0.1, 0.8]);
  });

  it("stays inside the limits and as wide as asked at either end", () => {
    expect(fittedDomain([0.99, 1], shares)).toEqual([0.7, 1]);
    expect(fittedDomain([0, 0.01], shares)).toEqual([0, 0.3]);
    expect(fittedDomain([0.5], shares)).toEqual([0.4, 0.7]);
  });

  it("is the limits where nothing is known", () => {
    expect(fittedDomain([Number.NaN], shares)).toEqual([0, 1]);
  });
});
