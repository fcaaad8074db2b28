import { expect, it } from "vitest";
import type { NewDecision, StoredDecision } from "../api/types";
import { EMPTY_SCENE } from "../canvas/scene";
import { SHOW_ALL } from "./label_state";
import { openLabelStore } from "./open_store";
import { Stopwatch } from "./stopwatch";
import { candidate } from "./test_candidates";

const stored: StoredDecision = {
  id: 1,
  segment_id: 1,
  verdict: "keep",
  previous: "undecided",
  kind: "judge",
  client_id: "stored",
  group_id: "g1",
  target_group_id: null,
  elapsed_ms: 500,
  reason: null,
  suggestion: null,
  person: "owner",
  created_at: "2026-01-01T00:00:00Z",
};

function open(pending: NewDecision[]) {
  return openLabelStore(
    {
      imageId: 9,
      imageWidth: 200,
      imageHeight: 100,
      candidates: [candidate(1, { verdict: "keep" }), candidate(2)],
      scene: EMPTY_SCENE,
      lastDecisionId: 0,
    },
    {
      pending,
      order: "position",
      shown: SHOW_ALL,
      stopwatch: new Stopwatch(() => 0),
      newId: () => "new",
      record: () => undefined,
    },
  );
}

it("undoes decisions of an earlier visit", () => {
  const store = open([]);
  expect(store.undo()).toBeNull();
  store.catchUp([stored], []);
  expect(store.undo()?.id).toBe("g1");
  expect(store.getState().verdicts).toEqual(["undecided", "undecided"]);
});

it("shows decisions that are still in the outbox, and undoes them first", () => {
  const pending: NewDecision[] = [
    { client_id: "mine", group_id: "g2", kind: "judge", segment_id: 2, verdict: "reject" },
  ];
  const store = open(pending);
  expect(store.getState().verdicts).toEqual(["keep", "reject"]);
  store.catchUp([stored], pending);
  expect(store.undo()?.id).toBe("g2");
  expect(store.undo()?.id).toBe("g1");
  expect(store.getState().verdicts).toEqual(["undecided", "undecided"]);
});

it("counts a decision once whose acknowledgement got lost", () => {
  const pending: NewDecision[] = [
    { client_id: "stored", group_id: "g1", kind: "judge", segment_id: 1, verdict: "keep" },
  ];
  const store = open(pending);
  store.catchUp([stored], pending);
  expect(store.getState().history.done).toHaveLength(1);
});
