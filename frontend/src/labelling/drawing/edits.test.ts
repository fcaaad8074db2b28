import { describe, expect, it } from "vitest";
import type { Edit, StoredDecision } from "../../api/types";
import { candidate } from "../test_candidates";
import { undecidedStore } from "../test_store";
import { carriedSelection } from "./carried_selection";
import { describeEdit, describeEditReplay, editedSegments, isOutOfDate } from "./edits";

const DECISION: StoredDecision = {
  id: 1,
  segment_id: 1,
  verdict: "undecided",
  previous: "undecided",
  kind: "judge",
  client_id: "a",
  group_id: "g",
  target_group_id: null,
  elapsed_ms: null,
  reason: null,
  suggestion: null,
  person: null,
  created_at: "2025-06-01T12:00:00Z",
};
const TIME = "2025-06-01T12:00:00Z";

function edit(replaced: number[], added: number[], undone = false): Edit {
  return {
    id: 1,
    image_id: 1,
    client_id: `${replaced}>${added}`,
    kind: "cut",
    person: null,
    replaced,
    added,
    created_at: TIME,
    undone_at: undone ? TIME : null,
  };
}

const has =
  (...ids: number[]) =>
  (id: number) =>
    ids.includes(id);

describe("edits", () => {
  it("name the segments that come and go with them", () => {
    expect(editedSegments([edit([1], [2, 3]), edit([], [4], true)])).toEqual(new Set([1, 2, 3, 4]));
  });

  it("tell whether candidates were fetched before them", () => {
    const edits = [edit([1], [2, 3]), edit([3], [4])];
    expect(isOutOfDate(edits, has(2, 4))).toBe(false);
    expect(isOutOfDate(edits, has(1))).toBe(true);
    expect(isOutOfDate(edits, has(2, 3))).toBe(true);
  });

  it("tell it of undone ones too", () => {
    expect(isOutOfDate([edit([1], [2, 3], true)], has(1))).toBe(false);
    expect(isOutOfDate([edit([1], [2, 3], true)], has(2, 3))).toBe(true);
    expect(isOutOfDate([edit([1], [2, 3]), edit([3], [4], true)], has(2, 3))).toBe(false);
  });

  it("are told in words", () => {
    expect(describeEdit("trace", [1312.4])).toBe("Line added, 1,312 px");
    expect(describeEdit("cut", [150, 149.6])).toBe("Line cut in two, 150 px and 150 px");
    expect(describeEditReplay("undo", "extend")).toBe("Undone: extension");
  });
});

describe("the history of an image with edits", () => {
  it("keeps what was drawn and undone, although its line isn't there", () => {
    const store = undecidedStore([candidate(1)]);
    const drawn = { ...DECISION, segment_id: 2, verdict: "keep", kind: "judge", group_id: "drawn" } as const;
    const undone = {
      ...DECISION,
      segment_id: 2,
      kind: "undo",
      group_id: "z",
      target_group_id: "drawn",
    } as const;
    const decisions = [drawn, { ...undone, client_id: "b" }];
    store.catchUp(decisions, [], editedSegments([edit([], [2], true)]));
    expect(store.getState().history.undone.map(({ id }) => id)).toEqual(["drawn"]);
    store.catchUp(decisions, []);
    expect(store.getState().history.undone).toEqual([]);
  });
});

describe("the selection after candidates were fetched again", () => {
  it("is what the edit brought, or what it gave back", () => {
    expect(carriedSelection([[1]], edit([1], [2, 3]), has(2, 3, 9))).toEqual([2]);
    const join = { ...edit([1, 2], [3], true), kind: "join" as const };
    expect(carriedSelection([[3]], join, has(1, 2, 9))).toEqual([1, 2]);
    expect(carriedSelection([[2]], edit([1], [2, 3], true), has(1, 9))).toEqual([1]);
  });

  it("is what it was before a line was drawn that is taken back", () => {
    expect(carriedSelection([[4], [9]], edit([], [4], true), has(8, 9))).toEqual([9]);
    expect(carriedSelection([[4], []], edit([], [4], true), has(8))).toEqual([]);
  });

  it("is what it was where nothing of it changed", () => {
    expect(carriedSelection([[9]], edit([], [4], true), has(9))).toEqual([9]);
    expect(carriedSelection([[9, 8]], null, has(9))).toEqual([9]);
  });
});
