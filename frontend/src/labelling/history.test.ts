import { describe, expect, it } from "vitest";
import type { DecisionKind, Verdict } from "../api/types";
import { asRecorded, describeReplay, NO_HISTORY, pushed, rebuildHistory, redone, undone } from "./history";

const NO_REASONS = { from: null, to: null };
const CHANGE = { segmentId: 1, from: "undecided", to: "keep", reasons: NO_REASONS } as const;
const group = (id: string) => ({ id, changes: [CHANGE] });
const ids = (groups: readonly { id: string }[]) => groups.map(({ id }) => id);
const all = () => true;

function recorded(kind: DecisionKind, groupId: string, segment: number, target: string | null = null) {
  const [previous, verdict]: Verdict[] = kind === "undo" ? ["keep", "undecided"] : ["undecided", "keep"];
  return {
    kind,
    group_id: groupId,
    target_group_id: target,
    segment_id: segment,
    previous: previous as Verdict,
    verdict: verdict as Verdict,
  };
}

describe("what was undone is said", () => {
  const change = (to: "keep" | "undecided") => ({
    segmentId: 1,
    from: "reject" as const,
    to,
    reasons: NO_REASONS,
  });

  it("with its verdict and its extent", () => {
    expect(describeReplay("undo", { id: "a", changes: [change("keep")] })).toBe("Undone: keep");
    const changes = Array.from({ length: 1200 }, () => change("undecided"));
    expect(describeReplay("redo", { id: "a", changes })).toBe(
      "Redone: back to undecided of 1,200 candidates",
    );
  });
});

describe("history", () => {
  it("goes back and forth", () => {
    let history = pushed(pushed(NO_HISTORY, group("a")), group("b"));
    history = undone(undone(history));
    expect([ids(history.done), ids(history.undone)]).toEqual([[], ["b", "a"]]);
    history = redone(history);
    expect([ids(history.done), ids(history.undone)]).toEqual([["a"], ["b"]]);
  });

  it("forgets what was undone at a new judgement", () => {
    const history = pushed(undone(pushed(NO_HISTORY, group("a"))), group("b"));
    expect([ids(history.done), ids(history.undone)]).toEqual([["b"], []]);
  });

  it("stays as it is where there is nothing to undo", () => {
    expect(undone(NO_HISTORY)).toBe(NO_HISTORY);
    expect(redone(NO_HISTORY)).toBe(NO_HISTORY);
  });
});

describe("history rebuilt from the server's decisions", () => {
  it("has one entry per group", () => {
    const history = rebuildHistory(
      [recorded("judge", "a", 1), recorded("judge", "b", 2), recorded("judge", "b", 3)],
      all,
    );
    expect(ids(history.done)).toEqual(["a", "b"]);
    expect(history.done[1]?.changes.map((change) => change.segmentId)).toEqual([2, 3]);
  });

  it("moves a group once, however many decisions undid it", () => {
    const history = rebuildHistory(
      [
        recorded("judge", "a", 1),
        recorded("judge", "b", 2),
        recorded("judge", "b", 3),
        recorded("undo", "c", 2, "b"),
        recorded("undo", "c", 3, "b"),
      ],
      all,
    );
    expect([ids(history.done), ids(history.undone)]).toEqual([["a"], ["b"]]);
  });

  it("redoes, and clears what can be redone at the next judgement", () => {
    const decisions = [
      recorded("judge", "a", 1),
      recorded("undo", "b", 1, "a"),
      recorded("redo", "c", 1, "a"),
    ];
    expect(ids(rebuildHistory(decisions, all).done)).toEqual(["a"]);
    const later = [...decisions, recorded("undo", "d", 1, "a"), recorded("judge", "e", 2)];
    expect(ids(rebuildHistory(later, all).undone)).toEqual([]);
  });

  it("leaves carried and imported verdicts out", () => {
    expect(rebuildHistory([recorded("carry", "a", 1), recorded("import", "b", 2)], all)).toEqual(NO_HISTORY);
  });

  it("drops segments that a newer run replaced", () => {
    const history = rebuildHistory(
      [recorded("judge", "a", 1), recorded("judge", "b", 2), recorded("judge", "b", 3)],
      (segment) => segment === 3,
    );
    expect(history.done).toEqual([{ id: "b", changes: [{ ...CHANGE, segmentId: 3 }] }]);
  });
});

describe("decisions that the server doesn't have yet", () => {
  it("know what stood before them", () => {
    const decision = { client_id: "x", group_id: "g", kind: "judge", segment_id: 5 } as const;
    const list = asRecorded(
      [
        { ...decision, verdict: "reject" },
        { ...decision, verdict: "keep" },
      ],
      () => ({ verdict: "ambiguous", reason: null }),
    );
    expect(list.map(({ previous }) => previous)).toEqual(["ambiguous", "reject"]);
  });
});
