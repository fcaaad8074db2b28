import { describe, expect, it } from "vitest";
import { degrees, describeLine, lineTitle, pixels, rejectionText } from "./match_text";
import { matched } from "./test_images";

describe("texts of scored lines", () => {
  it("count from 1", () => {
    expect(lineTitle({ kind: "prediction", name: "p12" })).toBe("Prediction 13");
  });

  it("have units, and a dash for what there is none of", () => {
    expect([pixels(1.26), pixels(null), degrees(Math.PI / 180), degrees(null)]).toEqual([
      "1.3 px",
      "–",
      "1.00°",
      "–",
    ]);
  });

  it("say why people rejected the line that a false positive is", () => {
    const image = matched([], [{ row: [0, 100, 10], rejected_as: "lane_marking" }, { row: [0, 100, 90] }]);
    expect(image.lines.map(rejectionText)).toEqual(["rejected by hand as: lane marking", null]);
    expect(describeLine(image.lines[0] ?? null, null, 1)).toContain(", rejected by hand as: lane marking,");
  });

  it("say to screen readers what is selected", () => {
    const facts = {
      outcome: "false_alarm",
      error_type: "offset",
      best_label: 0,
      liou: 0.4,
      score: 0.7,
    } as const;
    const image = matched([{ row: [0, 100, 10] }], [{ row: [0, 120, 18], ...facts }]);
    expect(describeLine(image.lines[1] ?? null, 2, 3)).toBe(
      "False positive, prediction 1, error 2 of 3, offset, 120 pixels long, L I O U 0.40, score 0.70",
    );
    expect(describeLine(null, null, 3)).toBe("No line selected");
  });
});
