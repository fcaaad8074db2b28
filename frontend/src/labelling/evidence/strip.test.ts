import { describe, expect, test } from "vitest";
import { layOutStrip, roundReach } from "./strip";

describe("the strip of deviations", () => {
  test("a straight line's noise isn't blown up to fill the strip", () => {
    expect(roundReach(0)).toBe(0.5);
    expect(roundReach(0.13)).toBe(0.5);
  });

  test("larger deviations get a round scale", () => {
    expect(roundReach(0.51)).toBe(1);
    expect(roundReach(1)).toBe(1);
    expect(roundReach(1.2)).toBe(2);
    expect(roundReach(3)).toBe(5);
    expect(roundReach(14)).toBe(20);
  });

  test("positive deviations lie above the middle", () => {
    const strip = layOutStrip([0, 50, 100], [0, 0.5, -0.25], 200, 40);
    expect(strip.reach).toBe(0.5);
    expect(strip.path).toBe("M0.0 20.0L100.0 0.0L200.0 30.0");
    // 200 screen px for 100 px along, 40 screen px for 1 px across
    expect(strip.magnification).toBe(20);
    expect(strip.band).toBe(40);
  });

  test("a single place draws no line", () => {
    expect(layOutStrip([0], [0], 200, 40)).toMatchObject({ path: "M0.0 20.0", magnification: 0 });
  });
});
