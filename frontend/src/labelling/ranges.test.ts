import { describe, expect, it } from "vitest";
import {
  areLimited,
  endAt,
  isBeyond,
  isInRanges,
  NO_RANGES,
  placeOf,
  type Ranges,
  type Stops,
  stopsFor,
} from "./ranges";
import { candidate } from "./test_candidates";

const short = candidate(1, { length: 30, residual: null });
const long = candidate(2, { length: 412.4, residual: 0.31 });
const ranges: Ranges = { ...NO_RANGES, length: { low: 60, high: null } };

describe("ranges", () => {
  it("leave out what lies beyond an end, and keep the end itself", () => {
    expect(isInRanges(short, ranges)).toBe(false);
    expect(isInRanges(long, ranges)).toBe(true);
    expect(isInRanges(candidate(3, { length: 60 }), ranges)).toBe(true);
    expect(isBeyond(short, "length", "low", ranges.length)).toBe(true);
    expect(isBeyond(short, "length", "high", ranges.length)).toBe(false);
  });

  it("leave out nothing that wasn't measured", () => {
    expect(isInRanges(short, { ...NO_RANGES, residual: { low: 0.1, high: 0.2 } })).toBe(true);
    expect(isInRanges(long, { ...NO_RANGES, residual: { low: 0.1, high: 0.2 } })).toBe(false);
  });

  it("limit nothing at first", () => {
    expect(areLimited(NO_RANGES)).toBe(false);
    expect(areLimited(ranges)).toBe(true);
  });
});

describe("a slider", () => {
  const stops = stopsFor("length", [short, long]) as Stops;

  it("has a value of its own at each stop, up to beyond the largest", () => {
    expect(stops[0]).toBe(0);
    expect(stops.every((stop, place) => place === 0 || stop > (stops[place - 1] ?? 0))).toBe(true);
    expect(stops.at(-1)).toBeGreaterThan(412.4);
  });

  it("stands where it was put", () => {
    for (const measure of ["length", "score", "residual"] as const) {
      const found = stopsFor(measure, [short, long]) as Stops;
      for (let place = 1; place < found.length - 1; place++) {
        expect(placeOf(endAt(place, "low", found), "low", found)).toBe(place);
        expect(placeOf(endAt(place, "high", found), "high", found)).toBe(place);
      }
    }
  });

  it("means no end at its outer stops", () => {
    expect(endAt(0, "low", stops)).toBeNull();
    expect(endAt(stops.length - 1, "high", stops)).toBeNull();
    expect(placeOf(null, "low", stops)).toBe(0);
    expect(placeOf(null, "high", stops)).toBe(stops.length - 1);
  });

  it("stands at the nearest stop for an end chosen on another image", () => {
    expect(stops[placeOf(10_000, "high", stops)]).toBe(stops.at(-1));
  });

  it("isn't there for what no candidate has", () => {
    expect(stopsFor("residual", [short])).toBeNull();
  });
});
