import { describe, expect, it } from "vitest";
import { lineNamed } from "./matched_image";
import { matched } from "./test_images";
import { readAddress } from "./viewer_address";
import { changeState, startState, type ViewerChange, type ViewerState } from "./viewer_state";

const image = matched(
  [{ row: [0, 100, 10], outcome: "hit" }],
  [
    { row: [0, 100, 10], outcome: "hit", best_label: 0, liou: 1 },
    { row: [0, 100, 300], outcome: "false_alarm" },
  ],
);
const PREFERENCES = { order: "near", palette: "safe" } as const;

function start(query = ""): ViewerState {
  return startState(5, readAddress(query), PREFERENCES);
}

function select(state: ViewerState, side: "a" | "b", name: string | null): ViewerState {
  return changeState(state, { type: "selected", side, line: lineNamed(image, name), image, follow: false });
}

function changed(state: ViewerState, ...changes: ViewerChange[]): ViewerState {
  return changes.reduce(changeState, state);
}

describe("the viewer", () => {
  it("starts as the address says, else as one likes it", () => {
    expect(start("?order=place").order).toBe("place");
    expect(start()).toMatchObject({ order: "near", palette: "safe", side: "a", sideBySide: false });
    expect(start("?view=both&side=b").sideBySide).toBe(false);
  });

  it("goes to the line that the address names", () => {
    expect(start("?with=2&side=b&segment=p1")).toMatchObject({
      selected: { a: null, b: "p1" },
      followRequest: 1,
    });
    expect(start().followRequest).toBe(0);
  });

  it("selects the same label on both sides", () => {
    expect(select(start("?with=2"), "b", "l0")).toMatchObject({ side: "b", selected: { a: "l0", b: "l0" } });
  });

  it("selects a prediction's label on the other side, and nothing where it has none", () => {
    expect(select(start("?with=2"), "a", "p0").selected).toEqual({ a: "p0", b: "l0" });
    expect(select(start("?with=2"), "a", "p1").selected).toEqual({ a: "p1", b: null });
  });

  it("begins each image without a selection, unless the address names one", () => {
    const selected = select(start(), "a", "p1");
    expect(changeState(selected, { type: "opened", imageId: 5, segment: null })).toBe(selected);
    expect(changeState(selected, { type: "opened", imageId: 6, segment: null })).toMatchObject({
      imageId: 6,
      selected: { a: null, b: null },
      followRequest: 0,
    });
    expect(changeState(selected, { type: "opened", imageId: 6, segment: "l2" }).selected.a).toBe("l2");
  });

  it("compares nothing with nothing", () => {
    const state = start();
    expect(changed(state, { type: "sideBySide" }, { type: "differences" }, { type: "side", side: "b" })).toBe(
      state,
    );
  });

  it("ends a comparison on its own submission", () => {
    const both = select(start("?with=2&view=both&differences=1"), "b", "l0");
    expect(changeState(both, { type: "compared", other: null })).toMatchObject({
      other: null,
      side: "a",
      sideBySide: false,
      differences: false,
      selected: { a: "l0" },
    });
  });

  it("forgets a prediction of the submission that is replaced", () => {
    const both = select(start("?with=2&view=both"), "b", "p1");
    expect(changeState(both, { type: "compared", other: 9 }).selected.b).toBeNull();
  });

  it("shows the lines again with any layer", () => {
    const bare = changed(start(), { type: "bare" });
    expect(bare.bare).toBe(true);
    expect(changeState(bare, { type: "layer", layer: "found" })).toMatchObject({
      bare: false,
      shown: { found: true, tp: true },
    });
  });
});
