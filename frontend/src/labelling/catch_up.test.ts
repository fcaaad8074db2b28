import { describe, expect, it } from "vitest";
import type { NewDecision, StoredDecision, Verdict } from "../api/types";
import { caughtUp } from "./catch_up";
import { NO_HISTORY } from "./history";
import { type LabelState, SHOW_ALL } from "./label_state";
import { NOT_SUGGESTING } from "./suggestions/suggestions";
import { candidate } from "./test_candidates";
import { countVerdicts } from "./verdicts";

const candidates = [candidate(1), candidate(2), candidate(3)];
const indexOf = new Map(candidates.map(({ id }, index) => [id, index]));

function stateWith(verdicts: Verdict[]): LabelState {
  return {
    candidates,
    verdicts,
    reasons: verdicts.map(() => null),
    counts: countVerdicts(verdicts),
    sequence: [0, 1, 2],
    order: "position",
    selected: null,
    selection: [],
    shown: SHOW_ALL,
    suggesting: NOT_SUGGESTING,
    history: NO_HISTORY,
    followRequest: 0,
  };
}

const given = (id: string, segment: number, verdict: Verdict): NewDecision => ({
  client_id: id,
  group_id: id,
  kind: "judge",
  segment_id: segment,
  verdict,
});

const stored = (id: string, segment: number, verdict: Verdict, previous: Verdict): StoredDecision => ({
  ...given(id, segment, verdict),
  kind: "judge",
  id: 1,
  previous,
  target_group_id: null,
  elapsed_ms: null,
  reason: null,
  suggestion: null,
  person: null,
  created_at: "2025-01-01T00:00:00Z",
});

describe("decisions made elsewhere", () => {
  it("are taken over, and told apart from those that replace one of here", () => {
    const caught = caughtUp(
      stateWith(["keep", "undecided", "undecided"]),
      indexOf,
      [
        stored("a", 1, "keep", "undecided"),
        stored("b", 1, "reject", "keep"),
        stored("c", 2, "keep", "undecided"),
      ],
      [],
    );
    expect(caught.verdicts).toEqual(["reject", "keep", "undecided"]);
    expect(caught.changed).toEqual([0, 1]);
    expect(caught.replaced).toEqual([0]);
    expect(caught.history.done.map((group) => group.id)).toEqual(["a", "b", "c"]);
  });

  it("stand below what waits here to be sent, which comes later", () => {
    const caught = caughtUp(
      stateWith(["reject", "undecided", "undecided"]),
      indexOf,
      [stored("a", 1, "keep", "undecided")],
      [given("mine", 1, "reject")],
    );
    expect(caught.verdicts[0]).toBe("reject");
    expect(caught.changed).toEqual([]);
    expect(caught.history.done.at(-1)?.changes).toEqual([
      { segmentId: 1, from: "keep", to: "reject", reasons: { from: null, to: null } },
    ]);
  });

  it("count once where the server knows an unsent one already", () => {
    const caught = caughtUp(
      stateWith(["keep", "undecided", "undecided"]),
      indexOf,
      [stored("mine", 1, "keep", "undecided"), stored("b", 1, "ambiguous", "keep")],
      [given("mine", 1, "keep")],
    );
    expect(caught.verdicts[0]).toBe("ambiguous");
    expect(caught.history.done).toHaveLength(2);
  });

  it("on candidates of an earlier run change nothing", () => {
    const caught = caughtUp(
      stateWith(["undecided", "undecided", "undecided"]),
      indexOf,
      [stored("a", 99, "keep", "undecided")],
      [],
    );
    expect(caught.changed).toEqual([]);
    expect(caught.history).toEqual(NO_HISTORY);
  });
});
