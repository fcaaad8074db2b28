import { describe, expect, it } from "vitest";
import {
  formatBytes,
  formatCount,
  formatDuration,
  formatQuantity,
  formatSpeed,
  sentence,
  splitForEllipsis,
} from "./format";

describe("splitForEllipsis", () => {
  it("keeps the end of a long name", () => {
    expect(splitForEllipsis("drive_0001/frame_000123", 6)).toEqual(["drive_0001/frame_", "000123"]);
  });

  it("leaves short names whole", () => {
    expect(splitForEllipsis("000123", 6)).toEqual(["000123", ""]);
    expect(splitForEllipsis("", 6)).toEqual(["", ""]);
  });

  it("cuts between characters, not within one", () => {
    expect(splitForEllipsis("straße_🚗🚗🚗🚗", 2)).toEqual(["straße_🚗🚗", "🚗🚗"]);
  });

  it("loses nothing", () => {
    for (const name of ["a", "ab/cd", "x".repeat(400)]) expect(splitForEllipsis(name).join("")).toBe(name);
  });
});

describe("sentence", () => {
  it("begins with a capital letter and ends with a full stop, once", () => {
    expect(sentence("there is no dataset nope")).toBe("There is no dataset nope.");
    expect(sentence("Is it still running?")).toBe("Is it still running?");
  });
});

it("rounds as people do", () => {
  expect(formatBytes(999)).toBe("999 B");
  expect(formatBytes(1_250_000)).toBe("1.3 MB");
  expect(formatSpeed(1_500.4)).toBe("2 kB/s");
  expect(formatDuration(0.2)).toBe("1 s");
  expect(formatDuration(125 * 60)).toBe("2 h 5 min");
});

it("writes whole numbers as the browser would", () => {
  const browsers = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
  for (const count of [0, 7, 999, 1_000, 12_345, 600_000, 1_234_567, -1_234, 41.6]) {
    expect(formatCount(count)).toBe(browsers.format(count));
  }
  expect(formatQuantity(1, "image")).toBe("1 image");
  expect(formatQuantity(2_000, "image")).toBe("2,000 images");
});
