import { describe, expect, it } from "vitest";
import { differenceOf, liesOn } from "./difference";
import { matched, type TestLabel, type TestPrediction } from "./test_images";

type Found = "hit" | "miss" | "ignored";
const label = (y: number, outcome: Found): TestLabel => ({ row: [0, 100, y], outcome });
const hit = (y: number, best_label: number): TestPrediction => ({
  row: [0, 100, y],
  outcome: "hit",
  best_label,
  liou: 1,
});
const alarm = (x0: number, x1: number, y: number): TestPrediction => ({
  row: [x0, x1, y],
  outcome: "false_alarm",
});

const a = matched(
  [label(10, "hit"), label(50, "hit"), label(90, "miss"), label(130, "miss"), label(170, "ignored")],
  [hit(10, 0), hit(50, 1), alarm(0, 200, 300), alarm(0, 200, 400)],
);
const b = matched(
  [label(10, "hit"), label(50, "miss"), label(90, "hit"), label(130, "miss"), label(170, "ignored")],
  [hit(90, 2), hit(10, 0), alarm(0, 190, 302), alarm(0, 80, 400), alarm(300, 400, 200)],
);

describe("two submissions", () => {
  const difference = differenceOf(a, b);
  const names = (side: "a" | "b") =>
    [...difference.lines[side]].map((index) => (side === "a" ? a : b).lines[index]?.name);

  it("differ by the labels that only one found", () => {
    expect([...difference.found.a]).toEqual(["l1"]);
    expect([...difference.found.b]).toEqual(["l2"]);
  });

  it("share false positives of which at least half lie together", () => {
    // 200 px of which the other one has 80 are another error; those 80 px are part of the first one's.
    expect([...difference.alarms.a].map((index) => a.lines[index]?.name)).toEqual(["p3"]);
    expect([...difference.alarms.b].map((index) => b.lines[index]?.name)).toEqual(["p4"]);
  });

  it("point out these labels in both, what found them, and the false positives of one alone", () => {
    expect(names("a")).toEqual(["l1", "l2", "p1", "p3"]);
    expect(names("b")).toEqual(["l1", "l2", "p0", "p4"]);
  });

  it("don't differ from themselves", () => {
    const none = differenceOf(a, a);
    expect([none.found.a.size, none.alarms.a.size, none.lines.a.size, none.lines.b.size]).toEqual([
      0, 0, 0, 0,
    ]);
  });
});

describe("a line lies on others", () => {
  const { scene } = matched([], [alarm(0, 230, 100)]);
  const liesOnOne = (x0: number, x1: number, y: number) =>
    liesOn(scene, 0, matched([], [alarm(x0, x1, y)]).scene, () => true);

  it("within 3 px", () => {
    expect(liesOnOne(0, 230, 103)).toBe(true);
    expect(liesOnOne(0, 230, 104)).toBe(false);
  });

  it("by half of its length or more, at whichever end", () => {
    expect([liesOnOne(0, 115, 100), liesOnOne(115, 230, 100)]).toEqual([true, true]);
    expect([liesOnOne(0, 100, 100), liesOnOne(130, 230, 100)]).toEqual([false, false]);
  });

  it("by several of them together", () => {
    const pieces = matched([], [alarm(0, 70, 100), alarm(150, 230, 101)]).scene;
    expect(liesOn(scene, 0, pieces, () => true)).toBe(true);
    expect(liesOn(scene, 0, pieces, (index) => index === 0)).toBe(false);
  });
});
