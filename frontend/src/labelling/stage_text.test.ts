import { describe, expect, it } from "vitest";
import type { ScorePart } from "../api/types";
import { describeJoin, describeStages, scoreBars, signed, typicalScore } from "./stage_text";
import { join, stageHistory } from "./test_stages";

const piece = { start: [0, 0], end: [1, 0], length: 1 } as const;
const pieces = (count: number) => Array.from({ length: count }, () => ({ ...piece }) as never);

function part(name: string, facts: Partial<ScorePart> = {}): ScorePart {
  return { name, value: 0, weight: 1, typical: 0, measured: null, unit: "", ...facts };
}

describe("a candidate's stages", () => {
  it("are said in one sentence", () => {
    const history = stageHistory({
      pieces: pieces(3),
      joins: [join(10, 12), join(40, 45, { flipped: true, round: "flipping" })],
      extended: [12.44, 0],
      trimmed: [1, 2],
    });
    expect(describeStages(history)).toBe(
      "3 pieces, 2 joins (1 flips its bright side). Extended 12.4 px at its start; trimmed 1.0 px at its start, 2.0 px at its end.",
    );
  });

  it("of an edge that was never broken say so", () => {
    expect(describeStages(stageHistory())).toBe("1 piece, never broken. Not extended; not trimmed.");
    expect(describeStages(stageHistory({ extended: [0.4, 3] }))).toContain("Extended 3.0 px at its end;");
  });

  it("say what closed each gap", () => {
    expect(describeJoin(join(0, 1))).toBe("along one edge");
    expect(describeJoin(join(0, 1, { round: "after extension" }))).toBe("after extension");
    expect(describeJoin(join(0, 1, { round: "flipping" }))).toBe("either side bright");
    expect(describeJoin(join(0, 1, { round: "flipping", flipped: true }))).toBe("bright side flips");
  });
});

describe("the bars of a score", () => {
  it("compare each feature with what is typical", () => {
    const bars = scoreBars([
      part("length", { value: 3, typical: 1, weight: 1.5, measured: 120.4, unit: "px" }),
      part("roughness", { value: 0.5, typical: 0.2, weight: -4, measured: 0.25, unit: "px" }),
      part("closeness", { value: -0.2, typical: -0.2, measured: 0.82, unit: "share" }),
    ]);
    expect(bars.map(({ name, measured }) => [name, measured])).toEqual([
      ["Length", "120 px"],
      ["Roughness", "0.25 px"],
      ["Closeness", "82 %"],
    ]);
    expect(bars.map(({ effect }) => effect)).toEqual([3, expect.closeTo(-1.2), 0]);
    expect(bars.map(({ share }) => share)).toEqual([1, expect.closeTo(-0.4), 0]);
  });

  it("of a typical candidate are short", () => {
    expect(scoreBars([part("contrast", { value: 0.1 })])[0]?.share).toBeCloseTo(0.1);
  });

  it("show a feature that nobody has words for as the score takes it", () => {
    expect(scoreBars([part("novelty", { value: 1.234 })])[0]).toMatchObject({
      name: "Novelty",
      measured: "1.23",
    });
  });

  it("have signs of their own", () => {
    expect([0.84, -0.31, 0.04, -0.04].map(signed)).toEqual(["+0.8", "−0.3", "0", "0"]);
  });

  it("start from the score of the typical candidate", () => {
    const score_parts = [part("length", { weight: 2, typical: 1, value: 9 })];
    expect(typicalScore(stageHistory({ intercept: -2, score_parts }))).toBeCloseTo(0.5);
  });
});
