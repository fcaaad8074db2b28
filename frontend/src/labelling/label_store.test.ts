import { beforeEach, describe, expect, it } from "vitest";
import type { NewDecision } from "../api/types";
import { describeSelection, SHOW_ALL, verdictAt } from "./label_state";
import type { LabelStore } from "./label_store";
import { candidate } from "./test_candidates";
import { undecidedStore } from "./test_store";

let recorded: NewDecision[];
let time: number;
let store: LabelStore;

beforeEach(() => {
  recorded = [];
  time = 0;
  const candidates = [candidate(1), candidate(2, { straight: false }), candidate(3), candidate(4)];
  store = undecidedStore(candidates, recorded, () => time);
});

const verdicts = () => store.getState().verdicts.join(" ");

describe("one's place", () => {
  it("is kept where a click beside a line deselects", () => {
    store.select(2);
    store.select(null);
    store.step(1);
    expect(store.getState().selected).toBe(3);
  });
});

describe("judging", () => {
  it("records the decision with its time and goes to the next undecided candidate", () => {
    store.selectFirstUndecided();
    time = 640;
    store.judgeSelected("keep");
    expect(recorded).toEqual([
      {
        client_id: expect.any(String),
        group_id: expect.any(String),
        kind: "judge",
        segment_id: 1,
        verdict: "keep",
        elapsed_ms: 640,
      },
    ]);
    expect(store.getState().selected).toBe(1);
    expect(store.getState().counts).toEqual({ undecided: 3, keep: 1, reject: 0, ambiguous: 0 });
  });

  it("tells the time of a key press once, however many it judges", () => {
    time = 900;
    store.judge([0, 1, 2], "reject");
    expect(recorded.map((entry) => entry.elapsed_ms)).toEqual([900, null, null]);
  });

  it("passes over what is judged already", () => {
    store.judge([1, 2], "reject");
    store.select(0);
    store.judgeSelected("keep");
    expect(store.getState().selected).toBe(3);
  });

  it("stays where it is after the last one", () => {
    store.judge([0, 1, 2], "reject");
    store.select(3);
    store.judgeSelected("keep");
    expect(store.getState().selected).toBe(3);
    expect(store.selectFirstUndecided()).toBe(false);
  });

  it("records nothing where nothing changes, but still goes on", () => {
    store.judge([0], "keep");
    recorded.length = 0;
    store.select(0);
    store.judgeSelected("keep");
    expect(recorded).toEqual([]);
    expect(store.getState().selected).toBe(1);
  });

  it("does nothing without a selection", () => {
    store.judgeSelected("keep");
    expect(recorded).toEqual([]);
  });
});

describe("undo", () => {
  it("takes back the rejection of all undecided as one step, and tells the server which", () => {
    store.judge([1], "keep");
    expect(store.rejectUndecided()).toBe(3);
    expect(verdicts()).toBe("reject keep reject reject");
    const rejection = recorded.at(-1)?.group_id;
    recorded.length = 0;
    store.undo();
    expect(verdicts()).toBe("undecided keep undecided undecided");
    expect(recorded).toHaveLength(3);
    expect(new Set(recorded.map((decision) => decision.target_group_id))).toEqual(new Set([rejection]));
    store.redo();
    expect(verdicts()).toBe("reject keep reject reject");
  });

  it("gives back the verdict before, and selects the candidate", () => {
    store.judge([2], "keep");
    store.judge([2], "ambiguous");
    store.select(0);
    store.undo();
    expect(verdictAt(store.getState(), 2)).toBe("keep");
    expect(store.getState().selected).toBe(2);
  });

  it("is nothing where nothing was done", () => {
    expect(store.undo()).toBeNull();
    expect(store.redo()).toBeNull();
    expect(recorded).toEqual([]);
  });
});

describe("what is shown", () => {
  it("decides where Tab goes", () => {
    store.setShown({ ...SHOW_ALL, bent: false });
    store.select(0);
    store.step(1);
    expect(store.getState().selected).toBe(2);
    store.step(-1);
    expect(store.getState().selected).toBe(0);
  });

  it("ends a selection that it hides", () => {
    store.select(1);
    store.setShown({ ...SHOW_ALL, bent: false });
    expect(store.getState().selected).toBeNull();
  });

  it("doesn't limit the rejection of all undecided", () => {
    store.setShown({ ...SHOW_ALL, bent: false });
    expect(store.rejectUndecided()).toBe(4);
  });
});

describe("the view", () => {
  it("follows the keyboard but not the mouse", () => {
    store.select(2);
    expect(store.getState().followRequest).toBe(0);
    store.step(1);
    expect(store.getState().followRequest).toBe(1);
  });
});

it("says what is selected", () => {
  expect(describeSelection(store.getState())).toBe("No candidate selected");
  store.select(1);
  expect(describeSelection(store.getState())).toBe(
    "Candidate 2 of 4, undecided, 100 pixels long, score 0.50, fails the straightness test",
  );
});
