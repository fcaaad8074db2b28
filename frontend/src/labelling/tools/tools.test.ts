import { beforeEach, describe, expect, it } from "vitest";
import type { Verdict } from "../../api/types";
import type { Point } from "../../canvas/geometry";
import { makeScene } from "../../canvas/scene";
import { BrushTool } from "./brush_tool";
import { LassoTool } from "./lasso_tool";
import { changedBetween, NOTHING_TOUCHED, Preview } from "./preview";
import { givenToAll } from "./stroke_effects";
import type { LineFinder } from "./tool_view";

/** Four upright lines at x = 0, 4, 40 and 80, from y = 0 to 100; image px are screen px. */
const COLUMNS = [0, 4, 40, 80];
const scene = makeScene({
  revision: 1,
  ids: Uint32Array.from(COLUMNS),
  offsets: Uint32Array.of(0, 2, 4, 6, 8),
  coordinates: Float32Array.from(COLUMNS.flatMap((x) => [x, 0, x, 100])),
});
let hidden: Set<number>;
let preview: Preview;
let judged: (readonly number[])[];
let selected: { indices: readonly number[]; additional: boolean }[];

const shown = (index: number) => !hidden.has(index);
const view: LineFinder = {
  linesAlong: (from, to, radius) => scene.along(from, to, radius, shown),
  linesNear: ({ x, y }, radius) => scene.near(x, y, radius, shown),
  linesWithin: (polygon) => scene.within(polygon, shown),
  redrawTool: () => undefined,
};

beforeEach(() => {
  hidden = new Set();
  preview = new Preview();
  judged = [];
  selected = [];
});

const brush = (verdict: Verdict = "reject") =>
  new BrushTool({
    colour: () => "red",
    view: () => view,
    preview,
    effect: givenToAll(verdict),
    judge: (verdicts) => judged.push([...verdicts.keys()].sort()),
  });
const lasso = () =>
  new LassoTool({
    view: () => view,
    preview,
    select: (indices, additional) => selected.push({ indices: [...indices].sort(), additional }),
  });

type Tool = { down(at: Point, screen: Point, shift: boolean): void; move(at: Point, screen: Point): void };

function drag(tool: Tool, places: readonly (readonly [number, number])[], shift = false): Point {
  const points = places.map(([x, y]) => ({ x, y }));
  const [first, ...others] = points as [Point, ...Point[]];
  tool.down(first, first, shift);
  for (const place of others) tool.move(place, place);
  return points.at(-1) ?? first;
}

describe("the brush", () => {
  it("judges all that a stroke comes close to as one group, and shows it before", () => {
    const tool = brush();
    const end = drag(tool, [
      [20, 50],
      [45, 50],
    ]);
    expect([...preview.get()]).toEqual([[2, "reject"]]);
    const further = { x: 90, y: 60 };
    tool.move(further, further);
    tool.up(end, end);
    expect(judged).toEqual([[2, 3]]);
    expect(preview.get()).toBe(NOTHING_TOUCHED);
  });

  it("finds what lies between two positions that a fast hand skips", () => {
    const tool = brush();
    const end = drag(tool, [
      [-30, 10],
      [120, 90],
    ]);
    tool.up(end, end);
    expect(judged).toEqual([[0, 1, 2, 3]]);
  });

  it("judges the nearest line alone where it is only clicked, although others lie within its reach", () => {
    const tool = brush("keep");
    const end = drag(tool, [
      [3, 50],
      [4, 51],
    ]);
    tool.up(end, end);
    expect(judged).toEqual([[1]]);
  });

  it("judges nothing where it touches nothing, or only what is hidden", () => {
    hidden.add(2);
    const tool = brush();
    const end = drag(tool, [
      [20, 50],
      [60, 50],
    ]);
    tool.up(end, end);
    expect(judged).toEqual([]);
  });

  it("forgets a stroke that is cancelled", () => {
    const tool = brush();
    drag(tool, [
      [-20, 50],
      [60, 50],
    ]);
    tool.cancel();
    expect(preview.get()).toBe(NOTHING_TOUCHED);
    tool.move({ x: 90, y: 50 }, { x: 90, y: 50 });
    expect(judged).toEqual([]);
    expect(preview.get()).toBe(NOTHING_TOUCHED);
  });

  it("shows while it rests what a click would judge", () => {
    const tool = brush("keep");
    tool.hover({ x: 42, y: 50 });
    expect([...preview.get()]).toEqual([[2, "keep"]]);
    tool.hover(null);
    expect(preview.get()).toBe(NOTHING_TOUCHED);
  });
});

describe("the lasso", () => {
  const loop = [
    [-10, -10],
    [50, -10],
    [50, 60],
    [-10, 60],
  ] as const;

  it("selects what it goes around for the most part", () => {
    const tool = lasso();
    const end = drag(tool, loop);
    expect([...preview.get().keys()].sort()).toEqual([0, 1, 2]);
    tool.up(end);
    expect(selected).toEqual([{ indices: [0, 1, 2], additional: false }]);
  });

  it("adds to the selection with Shift", () => {
    const tool = lasso();
    tool.up(drag(tool, loop, true));
    expect(selected[0]?.additional).toBe(true);
  });

  it("leaves out what it goes around by less than one half", () => {
    const tool = lasso();
    tool.up(drag(tool, [...loop.slice(0, 2), [50, 40], [-10, 40]]));
    expect(selected[0]?.indices).toEqual([]);
  });

  it("selects one line by a click, and nothing beside the lines", () => {
    const tool = lasso();
    tool.up(drag(tool, [[39, 50]]));
    tool.up(drag(tool, [[60, 50]]));
    expect(selected.map(({ indices }) => indices)).toEqual([[2], []]);
  });

  it("selects nothing where it is cancelled", () => {
    const tool = lasso();
    drag(tool, loop);
    tool.cancel();
    expect(selected).toEqual([]);
    expect(preview.get()).toBe(NOTHING_TOUCHED);
  });
});

describe("a preview", () => {
  it("tells only of changes", () => {
    let heard = 0;
    preview.subscribe(() => heard++);
    const both = (verdict: Verdict, [one, other] = [1, 2]) =>
      new Map([one, other].map((index) => [index as number, verdict]));
    preview.show(both("keep"));
    preview.show(both("keep", [2, 1]));
    preview.show(both("reject"));
    preview.clear();
    preview.clear();
    expect(heard).toBe(3);
  });

  it("names the lines that look different", () => {
    const touched = (indices: number[], verdict: Verdict | null) =>
      new Map(indices.map((index) => [index, verdict]));
    expect(changedBetween(touched([1, 2], "keep"), touched([2, 3], "keep"))).toEqual([1, 3]);
    expect(changedBetween(touched([1], "keep"), touched([1], "reject"))).toEqual([1]);
  });
});
