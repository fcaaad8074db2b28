import { describe, expect, it } from "vitest";
import { RequestFailed } from "../../api/problem";
import type { DecisionsStored, NewDecision, Verdict } from "../../api/types";
import { Outbox } from "../outbox";
import { memoryStorage, type OutboxStorage } from "../outbox_storage";
import { SeenDecisions } from "./seen_decisions";
import { describeStaleEdit, staleCandidates } from "./stale_decisions";

const ANSWER: DecisionsStored = {
  stored: 1,
  repeated: 0,
  verdicts: { undecided: 0, keep: 0, reject: 0, ambiguous: 0 },
  status: "open",
  last_decision_id: 9,
  others: [],
};

const decision = (id: string, segment: number, verdict: Verdict = "keep"): NewDecision => ({
  client_id: id,
  group_id: id,
  kind: "judge",
  segment_id: segment,
  verdict,
});

/** A server on which Jon rejected some segments by a decision; who has seen it may overrule it. */
function outboxBeside(rejected: ReadonlyMap<number, number>, storage: OutboxStorage = memoryStorage()) {
  const stored: string[] = [];
  const requests: { ids: string[]; seen: number | null }[] = [];
  const outbox = new Outbox({
    storage,
    wait: async () => undefined,
    patience: () => new Promise(() => undefined),
    send: async (_, decisions, seen) => {
      requests.push({ ids: decisions.map((entry) => entry.client_id), seen });
      const conflicts = decisions.flatMap(({ client_id, segment_id }) => {
        const decision_id = rejected.get(segment_id) ?? 0;
        const theirs = { verdict: "reject", person: "Jon", created_at: "2025-06-01T12:00:00Z", decision_id };
        return decision_id > (seen ?? 0) ? [{ client_id, segment_id, theirs }] : [];
      });
      if (conflicts.length > 0) {
        const details = { conflicts };
        throw new RequestFailed({
          title: "Conflict",
          status: 409,
          code: "stale-verdict",
          message: "Jon decided meanwhile.",
          details,
        });
      }
      stored.push(...decisions.map((entry) => entry.client_id));
      return ANSWER;
    },
  });
  return { outbox, stored, requests, storage };
}

describe("stale decisions", () => {
  it("are held back while everything else is sent", async () => {
    const { outbox, stored, requests, storage } = outboxBeside(new Map([[2, 7]]));
    outbox.add(1, [decision("a", 1), decision("b", 2), decision("c", 3)], 5);
    await outbox.flush();
    expect(stored).toEqual(["a", "c"]);
    expect(requests).toEqual([
      { ids: ["a", "b", "c"], seen: 5 },
      { ids: ["a", "c"], seen: 5 },
    ]);
    expect(outbox.getState().kind).toBe("stale");
    expect((await storage.all()).map((entry) => entry.decision.client_id)).toEqual(["b"]);
    const [candidate] = staleCandidates(outbox.getStale(), 1);
    expect(candidate).toMatchObject({ segmentId: 2, mine: "keep" });
    expect(candidate?.theirs).toMatchObject({ verdict: "reject", person: "Jon" });
    expect(staleCandidates(outbox.getStale(), 2)).toEqual([]);
  });

  it("are sent again by someone who knows the other verdict", async () => {
    const { outbox, stored, requests, storage } = outboxBeside(new Map([[2, 7]]));
    outbox.add(1, [decision("b", 2)], 5);
    await outbox.flush();
    outbox.keepMine(outbox.getStale());
    expect(outbox.pendingFor(1).map((entry) => entry.client_id)).toEqual(["b"]);
    await outbox.flush();
    expect([stored, requests.at(-1)?.seen]).toEqual([["b"], 7]);
    expect([outbox.getState().kind, await storage.all()]).toEqual(["saved", []]);
  });

  it("are forgotten when theirs is taken, or another verdict is given", async () => {
    const { outbox, stored, storage } = outboxBeside(new Map([[2, 7]]));
    outbox.add(1, [decision("b", 2)], 5);
    await outbox.flush();
    outbox.takeTheirs(outbox.getStale());
    expect(outbox.getState()).toEqual({ kind: "saved" });
    outbox.add(1, [decision("c", 2)], 5);
    await outbox.flush();
    outbox.add(1, [decision("d", 2, "ambiguous")], 7);
    await outbox.flush();
    expect([stored, outbox.getStale(), await storage.all()]).toEqual([["d"], [], []]);
  });

  it("are asked about again after a reload", async () => {
    const first = outboxBeside(new Map([[2, 7]]));
    first.outbox.add(1, [decision("b", 2)], 5);
    await first.outbox.flush();
    const second = outboxBeside(new Map([[2, 7]]), first.storage);
    await second.outbox.restore();
    await second.outbox.flush();
    expect(second.outbox.getStale().map((entry) => entry.decision.client_id)).toEqual(["b"]);
    expect(second.requests[0]).toEqual({ ids: ["b"], seen: 5 });
  });

  it("lead to the latest verdict of mine on each candidate", async () => {
    const { outbox } = outboxBeside(new Map([[2, 7]]));
    outbox.add(1, [decision("b", 2), decision("c", 2, "ambiguous")], 5);
    await outbox.flush();
    const [candidate, ...others] = staleCandidates(outbox.getStale(), 1);
    expect([candidate?.mine, candidate?.decisions.length, others]).toEqual(["ambiguous", 2, []]);
  });
});

describe("what was seen", () => {
  it("only rises", () => {
    const seen = new SeenDecisions();
    expect(seen.of(1)).toBeNull();
    seen.raise(1, 0);
    expect(seen.of(1)).toBe(0);
    seen.raise(1, 9);
    seen.raise(1, 4);
    expect([seen.of(1), seen.of(2)]).toEqual([9, null]);
  });

  it("parts batches whose decisions were made knowing more or less", async () => {
    const { outbox, requests } = outboxBeside(new Map());
    outbox.add(1, [decision("a", 1), decision("b", 2)], 5);
    outbox.add(1, [decision("c", 3)], 8);
    await outbox.flush();
    expect(requests).toEqual([
      { ids: ["a", "b"], seen: 5 },
      { ids: ["c"], seen: 8 },
    ]);
  });
});

describe("an edit that would overrule another's verdict", () => {
  const refused = (code: string) => ({
    title: "Conflict",
    status: 409,
    code,
    message: "Jon decided meanwhile.",
    details: {
      conflicts: [
        {
          client_id: "a",
          segment_id: 1,
          theirs: { verdict: "reject", person: "Jon", created_at: "", decision_id: 7 },
        },
      ],
    },
  });

  it("is told with theirs", () => {
    expect(describeStaleEdit(refused("stale-verdict"))).toMatch(
      /^Jon rejected this line meanwhile\. Nothing/,
    );
  });

  it("isn't told of where the refusal is another one", () => {
    expect(describeStaleEdit(refused("stale-edit"))).toBeNull();
  });
});
