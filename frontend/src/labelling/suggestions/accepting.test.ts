import { beforeEach, describe, expect, it } from "vitest";
import type { NewDecision } from "../../api/types";
import { candidateLook } from "../candidate_look";
import type { LabelStore } from "../label_store";
import { candidate } from "../test_candidates";
import { undecidedStore } from "../test_store";
import { NOTHING_TOUCHED } from "../tools/preview";
import type { Suggesting, Suggestion } from "./suggestions";

let recorded: NewDecision[];
let store: LabelStore;

const probabilities = [0.95, 0.05, 0.5, 0.9];

function suggesting(part: Partial<Suggesting> = {}): Suggesting {
  const of = probabilities.map(
    (probability, index): Suggestion => ({
      id: index + 1,
      probability,
      family: -1,
      value: [0.1, 0.2, 0.9, 0.3][index] as number,
      lens: [0.4, 0.1, 0.2, 0.3][index] as number,
      for: [],
      against: [],
    }),
  );
  return { of, thresholds: { keep: 0.8, reject: 0.2 }, shown: true, ...part };
}

beforeEach(() => {
  recorded = [];
  const candidates = [1, 2, 3, 4].map((number) => candidate(number));
  store = undecidedStore(candidates, recorded);
  store.setSuggesting(suggesting());
});

const verdicts = () => store.getState().verdicts.join(" ");

describe("accepting suggestions", () => {
  it("decides those given as one group, with the probability of each", () => {
    expect(store.acceptSuggested([0, 1, 2])).toEqual({ keep: 1, reject: 1 });
    expect(verdicts()).toBe("keep reject undecided undecided");
    expect(recorded.map(({ kind, suggestion }) => [kind, suggestion])).toEqual([
      ["accept", 0.95],
      ["accept", 0.05],
    ]);
    expect(new Set(recorded.map(({ group_id }) => group_id)).size).toBe(1);
  });

  it("is taken back by one undo", () => {
    store.acceptSuggested([0, 1, 2, 3]);
    store.undo();
    expect(verdicts()).toBe("undecided undecided undecided undecided");
    expect(recorded.filter(({ kind }) => kind === "undo")).toHaveLength(3);
  });

  it("leaves what is decided as it is", () => {
    store.judge([0], "reject");
    expect(store.acceptSuggested([0, 1])).toEqual({ keep: 0, reject: 1 });
    expect(verdicts()).toBe("reject reject undecided undecided");
  });

  it("goes on to the next undecided candidate where the selected one is decided", () => {
    store.select(0);
    store.acceptSuggested([0, 1, 3]);
    expect(store.getState().selected).toBe(2);
    store.acceptSuggested([3]);
    expect(store.getState().selected).toBe(2);
  });

  it("does nothing while suggestions are hidden", () => {
    store.setSuggesting(suggesting({ shown: false }));
    expect(store.acceptSuggested([0, 1])).toEqual({ keep: 0, reject: 0 });
    expect(recorded).toEqual([]);
  });
});

describe("a suggestion on the image", () => {
  const look = () => candidateLook(store.getState(), NOTHING_TOUCHED, "standard");
  const form = (index: number) => {
    const { dash, width } = look().style(index);
    return `${width}: ${dash.join(" ")}`;
  };

  it("is told from a verdict, and from what is undecided, by its form", () => {
    const marked = [0, 1, 2].map(form);
    expect(new Set(marked).size).toBe(3);
    store.acceptSuggested([0, 1]);
    expect([0, 1].map(form).filter((accepted) => marked.includes(accepted))).toEqual([]);
  });

  it("has the colour of the verdict that it suggests", () => {
    const suggested = [0, 1].map((index) => look().style(index).colour);
    store.acceptSuggested([0, 1]);
    expect([0, 1].map((index) => look().style(index).colour)).toEqual(suggested);
  });

  it("isn't marked while suggestions are hidden", () => {
    const undecided = form(2);
    store.setSuggesting(suggesting({ shown: false }));
    expect([0, 1].map(form)).toEqual([undecided, undecided]);
  });
});

describe("a verdict by hand", () => {
  it("tells which probability the person saw", () => {
    store.judge([2], "keep");
    store.setSuggesting(suggesting({ shown: false }));
    store.judge([3], "reject");
    expect(recorded.map(({ kind, suggestion }) => [kind, suggestion])).toEqual([
      ["judge", 0.5],
      ["judge", undefined],
    ]);
  });
});

describe("orders by what a look is worth", () => {
  it("follow the suggestions once they come", () => {
    store.setSuggesting({ ...suggesting(), of: [] });
    store.setOrder("value");
    expect(store.getState().sequence).toEqual([0, 1, 2, 3]);
    store.setSuggesting(suggesting());
    expect(store.getState().sequence).toEqual([2, 3, 1, 0]);
    store.setOrder("lens");
    expect(store.getState().sequence).toEqual([0, 3, 2, 1]);
  });

  it("stay as they are where only thresholds move", () => {
    store.setOrder("value");
    const { sequence } = store.getState();
    store.setSuggesting({ ...store.getState().suggesting, thresholds: { keep: 0.6, reject: 0.1 } });
    expect(store.getState().sequence).toBe(sequence);
  });
});
