import { beforeEach, describe, expect, it } from "vitest";
import type { NewDecision } from "../api/types";
import { candidateLook, changedLooks } from "./candidate_look";
import { familyOfSelection } from "./families";
import { describeSelection, reasonAt, SHOW_ALL } from "./label_state";
import type { LabelStore } from "./label_store";
import type { Suggesting, Suggestion } from "./suggestions/suggestions";
import { candidate } from "./test_candidates";
import { undecidedStore } from "./test_store";
import { NOTHING_TOUCHED } from "./tools/preview";

let recorded: NewDecision[];
let store: LabelStore;

beforeEach(() => {
  recorded = [];
  const candidates = [1, 2, 3, 4, 5].map((number) => candidate(number));
  store = undecidedStore(candidates, recorded);
});

const verdicts = () => store.getState().verdicts.join(" ");
const groups = () => new Set(recorded.map(({ group_id }) => group_id)).size;

/** Families of three and of one, by candidate. */
function families(...numbers: number[]): Suggesting {
  const of = numbers.map((family) => ({ family, probability: 0.5 }) as Suggestion);
  return { of, thresholds: { keep: 1, reject: 0 }, shown: false };
}

describe("a selection of several", () => {
  it("is in the order of review, however it came about", () => {
    store.selectAll([3, 1, 1]);
    expect(store.getState().selection).toEqual([1, 3]);
    expect(store.getState().selected).toBe(1);
  });

  it("grows and shrinks one by one", () => {
    store.select(0);
    store.toggleSelected(2);
    store.toggleSelected(4);
    expect(store.getState()).toMatchObject({ selection: [0, 2, 4], selected: 4 });
    store.toggleSelected(2);
    expect(store.getState().selection).toEqual([0, 4]);
    store.toggleSelected(4);
    store.toggleSelected(0);
    expect(store.getState()).toMatchObject({ selection: [], selected: null });
  });

  it("gets one verdict as one group, undone by one undo, and the review goes on", () => {
    store.selectAll([0, 1, 3]);
    store.judgeSelected("keep");
    expect(verdicts()).toBe("keep keep undecided keep undecided");
    expect([recorded.length, groups()]).toEqual([3, 1]);
    expect(store.getState()).toMatchObject({ selected: 2, selection: [2] });
    store.undo();
    expect(verdicts()).toBe("undecided undecided undecided undecided undecided");
  });

  it("loses what is hidden", () => {
    store.judge([0], "reject");
    store.selectAll([0, 1, 2]);
    store.setShown({ ...SHOW_ALL, verdicts: { ...SHOW_ALL.verdicts, reject: false } });
    expect(store.getState().selection).toEqual([1, 2]);
  });

  it("is told", () => {
    store.selectAll([0, 1, 3]);
    expect(describeSelection(store.getState())).toBe("3 candidates selected");
  });
});

describe("several judgements at once", () => {
  it("may be different ones, and are one step to undo", () => {
    store.decide(
      [
        { index: 0, verdict: "keep", suggestion: 0.9 },
        { index: 1, verdict: "reject", reason: "car" },
      ],
      "accept",
    );
    expect(verdicts()).toBe("keep reject undecided undecided undecided");
    expect(recorded.map(({ kind, suggestion, reason }) => [kind, suggestion, reason])).toEqual([
      ["accept", 0.9, undefined],
      ["accept", undefined, "car"],
    ]);
    store.undo();
    expect(verdicts()).toBe("undecided undecided undecided undecided undecided");
  });

  it("leave out what stands already", () => {
    store.judge([0], "keep");
    recorded.length = 0;
    expect(store.judge([0, 1], "keep")).toBe(true);
    expect(recorded.map(({ segment_id }) => segment_id)).toEqual([2]);
    expect(store.judge([0, 1], "keep")).toBe(false);
  });
});

describe("a reason", () => {
  it("goes with the rejection, and comes and goes with undo and redo", () => {
    store.select(0);
    store.judgeSelected("reject", { reason: "curved" });
    expect(reasonAt(store.getState(), 0)).toBe("curved");
    expect(recorded[0]).toMatchObject({ verdict: "reject", reason: "curved" });
    store.undo();
    expect(reasonAt(store.getState(), 0)).toBeNull();
    expect(recorded[1]).not.toHaveProperty("reason");
    store.redo();
    expect(recorded[2]).toMatchObject({ kind: "redo", verdict: "reject", reason: "curved" });
  });

  it("is changed by another one, and gives way to another verdict", () => {
    store.judge([0], "reject", { reason: "car" });
    store.judge([0], "reject", { reason: "shadow" });
    expect(reasonAt(store.getState(), 0)).toBe("shadow");
    store.undo();
    expect(reasonAt(store.getState(), 0)).toBe("car");
    store.judge([0], "keep");
    expect(reasonAt(store.getState(), 0)).toBeNull();
  });

  it("stays where a candidate is rejected once more without one", () => {
    store.judge([0], "reject", { reason: "car" });
    expect(store.judge([0], "reject")).toBe(false);
    expect(reasonAt(store.getState(), 0)).toBe("car");
    expect(store.judge([0], "reject", { reason: null })).toBe(true);
    expect(reasonAt(store.getState(), 0)).toBeNull();
  });
});

describe("a family", () => {
  it("is the selected candidate alone as long as none is known", () => {
    store.select(1);
    expect(familyOfSelection(store.getState())).toEqual([1]);
  });

  it("goes along with each of the selected, where it is shown", () => {
    store.setSuggesting(families(7, -1, 7, -1, 7));
    store.select(2);
    expect(familyOfSelection(store.getState())).toEqual([0, 2, 4]);
    store.judge([4], "reject");
    store.setShown({ ...SHOW_ALL, verdicts: { ...SHOW_ALL.verdicts, reject: false } });
    expect(familyOfSelection(store.getState())).toEqual([0, 2]);
    store.selectAll([1, 2]);
    expect(familyOfSelection(store.getState())).toEqual([0, 1, 2]);
  });
});

describe("the look of candidates", () => {
  const look = () => candidateLook(store.getState(), NOTHING_TOUCHED, "standard");

  it("shows what a tool would do before it is done", () => {
    const touched = new Map([[1, "keep"]] as const);
    const shown = candidateLook(store.getState(), touched, "standard").style(1);
    store.judge([1], "keep");
    expect(shown).toMatchObject({ colour: look().style(1).colour });
    expect(shown.casings).toBeDefined();
    expect(look().style(1).casings).toBeUndefined();
  });

  it("makes the others faint, or leaves them out, while something is selected", () => {
    store.setShown({ ...SHOW_ALL, focus: "dim" });
    expect(look().style(1).opacity).toBe(1);
    store.select(0);
    expect([look().style(0).opacity, look().style(1).opacity < 0.5]).toEqual([1, true]);
    store.setShown({ ...SHOW_ALL, focus: "solo" });
    expect([look().visible(0), look().visible(1)]).toEqual([true, false]);
    store.select(null);
    expect(look().visible(1)).toBe(true);
  });

  it("is drawn anew only where it may have changed", () => {
    const at = () => ({ state: store.getState(), touched: NOTHING_TOUCHED });
    let before = at();
    store.judge([2], "keep");
    expect(changedLooks(before, at())).toEqual([2]);
    before = at();
    store.selectAll([1, 3]);
    expect(changedLooks(before, at())).toEqual([1, 3]);
    before = at();
    store.setShown({ ...SHOW_ALL, bent: false });
    expect(changedLooks(before, at())).toBeNull();
  });

  it("has styles that are all known to whoever draws them", () => {
    store.selectAll([0, 1]);
    store.judge([2], "keep");
    store.setShown({ ...SHOW_ALL, focus: "dim" });
    const { styles, style } = look();
    expect([0, 1, 2, 3].every((index) => styles.includes(style(index)))).toBe(true);
  });
});
