import { beforeEach, describe, expect, it } from "vitest";
import type { Point } from "../../canvas/geometry";
import { makeScene } from "../../canvas/scene";
import type { LabelStore } from "../label_store";
import type { Suggestion } from "../suggestions/suggestions";
import { candidate } from "../test_candidates";
import { undecidedStore } from "../test_store";
import { BRUSH_RADIUS, BrushTool } from "./brush_tool";
import { Preview } from "./preview";
import cases from "./stroke_cases.json";
import { turned, turnedVerdicts } from "./stroke_effects";

const stroke = (touched: number[], first: number | null, last: number | null) => ({
  touched: new Set(touched),
  first,
  last,
});

describe("the turn brush", () => {
  let store: LabelStore;
  const probabilities = [0.9, 0.6, 0.4, 0.1, null];

  beforeEach(() => {
    store = undecidedStore([1, 2, 3, 4, 5].map((number) => candidate(number)));
    const of = probabilities.map((probability, index): Suggestion | null =>
      probability === null
        ? null
        : { id: index + 1, probability, family: -1, value: 0, lens: 0, for: [], against: [] },
    );
    store.setSuggesting({ of, thresholds: { keep: 0.5, reject: 0.5 }, shown: true });
  });

  const verdicts = (...given: Parameters<typeof stroke>) =>
    Object.fromEntries(turnedVerdicts(store.getState(), stroke(...given)));
  const all = [0, 1, 2, 3, 4];

  it("turns the lines at its ends, and what is as likely between", () => {
    store.acceptSuggested(all);
    expect(verdicts(all, 0, 2)).toEqual({ 0: "reject", 1: "reject", 2: "keep" });
    expect(verdicts(all, 2, 0)).toEqual(verdicts(all, 0, 2));
    expect(verdicts(all, 3, 3)).toEqual({ 3: "keep" });
  });

  it("takes an end beside the lines, or without a probability, for 50 %", () => {
    store.acceptSuggested(all);
    expect(verdicts(all, null, 3)).toEqual({ 2: "keep", 3: "keep" });
    expect(verdicts(all, 0, null)).toEqual({ 0: "reject", 1: "reject" });
    store.judge([4], "reject");
    expect(verdicts(all, 4, 0)).toEqual({ 0: "reject", 1: "reject", 4: "keep" });
  });

  it("turns all that it touches where neither end says how likely", () => {
    store.judge(all, "keep");
    store.judge([1], "reject");
    expect(verdicts([0, 1, 3], null, null)).toEqual({ 0: "reject", 1: "keep", 3: "reject" });
    store.setSuggesting({ ...store.getState().suggesting, shown: false });
    expect(verdicts([0, 1, 3], 0, 1)).toEqual({ 0: "reject", 1: "keep", 3: "reject" });
  });

  it("judges undecided lines against what is suggested, and leaves ambiguous ones", () => {
    store.judge([1], "ambiguous");
    expect(verdicts(all, 0, 3)).toEqual({ 0: "reject", 2: "keep", 3: "keep" });
    expect(verdicts([4], 4, 4)).toEqual({ 4: "keep" });
  });
});

describe("a straight stroke", () => {
  const { lines, probability, radius } = cases;
  const scene = makeScene({
    revision: 1,
    ids: Uint32Array.from(lines.keys()),
    offsets: Uint32Array.from([0, ...lines.map((_, index) => lines.slice(0, index + 1).flat().length)]),
    coordinates: Float32Array.from(lines.flat(2)),
  });

  // The replay of a review, benchmarks/shared/review_touching.py and review_turning.py, gives the same answers.
  it.each(cases.strokes)("touches and turns as the replay says: $stroke", (expected) => {
    const effects: { touched: number[]; ends: (number | null)[]; turned: number[] }[] = [];
    const scale = radius / BRUSH_RADIUS;
    const tool = new BrushTool({
      colour: () => "white",
      view: () => ({
        linesAlong: (from, to, reach) => scene.along(from, to, reach * scale, () => true),
        linesNear: ({ x, y }, reach) => scene.near(x, y, reach * scale, () => true),
        linesWithin: () => [],
        redrawTool: () => undefined,
      }),
      preview: new Preview(),
      effect: (made) => {
        const sorted = (indices: Iterable<number>) => [...indices].sort((a, b) => a - b);
        const { touched, first, last } = made;
        const turns = sorted(turned(made, (index) => probability[index] as number));
        effects.push({ touched: sorted(touched), ends: [first, last], turned: turns });
        return new Map();
      },
      judge: () => undefined,
    });
    const [from, to] = expected.stroke.map(([x, y]) => ({ x, y })) as [Point, Point];
    const middle = { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2 };
    tool.down(from, from);
    tool.move(middle, middle);
    tool.up(to, to);
    const { touched, ends, turned: turns } = expected;
    expect(effects.at(-1)).toEqual({ touched, ends, turned: turns });
  });
});
