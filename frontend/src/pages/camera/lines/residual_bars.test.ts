import { describe, expect, it } from "vitest";
import { residualBars } from "./residual_bars";

describe("residualBars", () => {
  it("counts every line once, in bars between round numbers", () => {
    const residuals = Array.from({ length: 48 }, (_, index) => index / 100);
    const bars = residualBars(residuals);
    expect(bars.reduce((sum, { value }) => sum + value, 0)).toBe(48);
    expect(bars[0]).toEqual({ label: "0", name: "0 to 0.02 px", value: 2 });
    expect(bars).toHaveLength(24);
  });

  it("gathers the few that are far off in the last bar", () => {
    const bars = residualBars([...Array.from({ length: 299 }, (_, index) => index / 1000), 40]);
    expect(bars.length).toBeLessThan(40);
    expect(bars.at(-1)?.name).toMatch(/ px and more$/);
    expect(bars.reduce((sum, { value }) => sum + value, 0)).toBe(300);
  });

  it("has nothing to show of nothing, and one bar where all are perfect", () => {
    expect(residualBars([])).toEqual([]);
    expect(residualBars([0, 0]).map(({ value }) => value)).toEqual([2]);
  });
});
