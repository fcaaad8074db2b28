import { describe, expect, test } from "vitest";
import { binNames, everyDay, timeText } from "./time_text";

describe("times of decisions", () => {
  test("short ones to a tenth, long ones roughly", () => {
    expect(timeText(840)).toBe("0.8 s");
    expect(timeText(12_300)).toBe("12 s");
    expect(timeText(150_000)).toBe("3 min");
    expect(timeText(null)).toBe("–");
  });

  test("the last bar has no upper end", () => {
    expect(binNames([0, 250, 30_000]).map((bin) => bin.name)).toEqual([
      "0 s to 0.25 s",
      "0.25 s to 30 s",
      "30 s and more",
    ]);
  });

  test("a pause is seen", () => {
    const days = [
      { day: "2025-02-27", decisions: 4 },
      { day: "2025-03-02", decisions: 7 },
    ];
    const all = everyDay(days, (day) => ({ day, decisions: 0 }));
    expect(all.map((entry) => [entry.day.slice(5), entry.decisions])).toEqual([
      ["02-27", 4],
      ["02-28", 0],
      ["03-01", 0],
      ["03-02", 7],
    ]);
    expect(everyDay([], (day) => ({ day }))).toEqual([]);
  });
});
