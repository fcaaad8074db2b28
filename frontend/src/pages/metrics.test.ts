import { describe, expect, it } from "vitest";
import { METRIC_GROUPS } from "./metric_groups";
import { differenceText, intervalText, isBetter, metricOf, metricText } from "./metrics";

describe("metrics", () => {
  it("have one entry each, with an explanation", () => {
    const all = METRIC_GROUPS.flatMap(({ metrics }) => metrics);
    expect(new Set(all.map(({ key }) => key)).size).toBe(all.length);
    for (const { meaning } of all) expect(meaning).not.toBe("");
  });

  it("are written in their own unit", () => {
    expect(metricText("f1", 0.61249)).toBe("0.612");
    expect(metricText("offset_mean", 0.8)).toBe("0.80 px");
    expect(metricText("angle_error", Math.PI / 180)).toBe("1.00°");
    expect(metricText("ap", null)).toBe("–");
    expect(metricText("bias", -0.001)).toBe("0.00 px");
  });

  it("show an interval with its unit once", () => {
    expect(intervalText("f1", { low: 0.58, high: 0.64 })).toBe("0.580 to 0.640");
    expect(intervalText("offset_mean", { low: 0.5, high: 1.25 })).toBe("0.50 to 1.25 px");
    expect(intervalText("angle_error", { low: 0, high: Math.PI / 90 })).toBe("0.00 to 2.00°");
    expect(intervalText("f1", { low: null, high: null })).toBe("");
  });

  it("give differences a sign, and none to nothing", () => {
    expect(differenceText("f1", 0.0214)).toBe("+0.021");
    expect(differenceText("f1", -0.0214)).toBe("-0.021");
    expect(differenceText("f1", 0.0001)).toBe("0.000");
  });

  it("know which end is better", () => {
    expect(isBetter("f1", 0.1)).toBe(true);
    expect(isBetter("offset_mean", 0.1)).toBe(false);
    expect(isBetter("fragmentation", 0.1)).toBeNull();
  });

  it("name one that isn't known by its key", () => {
    expect(metricOf("new_metric").name).toBe("new metric");
  });
});
