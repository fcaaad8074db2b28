import { describe, expect, it } from "vitest";
import { RequestFailed, unreachable } from "../api/problem";
import type { DecisionsStored, NewDecision } from "../api/types";
import { Outbox } from "./outbox";
import { memoryStorage, type OutboxStorage } from "./outbox_storage";

const ANSWER: DecisionsStored = {
  stored: 1,
  repeated: 0,
  verdicts: { undecided: 0, keep: 0, reject: 0, ambiguous: 0 },
  status: "open",
};

const decision = (id: string): NewDecision => ({
  client_id: id,
  group_id: id,
  kind: "judge",
  segment_id: 1,
  verdict: "keep",
});

const refusal = () =>
  new RequestFailed({ title: "Refused", status: 422, code: "refused", message: "No such segment." });

interface Sent {
  imageId: number;
  ids: string[];
}

/** An outbox whose server is a function; nothing waits for real time. */
function outboxTo(
  server: (imageId: number, ids: string[]) => void,
  storage: OutboxStorage = memoryStorage(),
) {
  const sent: Sent[] = [];
  let waits = 0;
  const outbox = new Outbox({
    storage,
    wait: async () => {
      waits++;
    },
    patience: () => new Promise(() => undefined),
    send: async (imageId, decisions) => {
      const ids = decisions.map((entry) => entry.client_id);
      server(imageId, ids);
      sent.push({ imageId, ids });
      return ANSWER;
    },
  });
  return { outbox, sent, storage, waits: () => waits };
}

async function settled(outbox: Outbox): Promise<void> {
  while (["saving", "offline"].includes(outbox.getState().kind)) await Promise.resolve();
}

describe("outbox", () => {
  it("sends in order, one batch per image, and then holds nothing", async () => {
    const { outbox, sent, storage } = outboxTo(() => undefined);
    outbox.add(1, [decision("a"), decision("b")]);
    outbox.add(1, [decision("c")]);
    outbox.add(2, [decision("d")]);
    expect(outbox.getState()).toEqual({ kind: "saving", waiting: 4 });
    await outbox.flush();
    expect(sent).toEqual([
      { imageId: 1, ids: ["a", "b", "c"] },
      { imageId: 2, ids: ["d"] },
    ]);
    expect(await storage.all()).toEqual([]);
    expect(outbox.getState()).toEqual({ kind: "saved" });
  });

  it("has a decision in storage before it sends it", async () => {
    const storage = memoryStorage();
    const stored: number[] = [];
    const { outbox } = outboxTo(() => undefined, {
      ...storage,
      add: async (entries) => {
        await storage.add(entries);
        stored.push(entries.length);
      },
    });
    outbox.subscribe(() => {
      if (outbox.getState().kind === "saved") stored.push(-1);
    });
    outbox.add(1, [decision("a")]);
    await outbox.flush();
    expect(stored[0]).toBe(1);
  });

  it("tries again until the server answers, and says so meanwhile", async () => {
    let failures = 3;
    const states: string[] = [];
    const { outbox, sent, waits } = outboxTo(() => {
      if (failures-- > 0) throw unreachable();
    });
    outbox.subscribe(() => states.push(outbox.getState().kind));
    outbox.add(1, [decision("a")]);
    await expect(outbox.flush()).rejects.toThrow("doesn't answer");
    await settled(outbox);
    expect(waits()).toBe(3);
    expect(sent).toEqual([{ imageId: 1, ids: ["a"] }]);
    expect(states).toContain("offline");
    expect(outbox.getState().kind).toBe("saved");
  });

  it("sends what an earlier visit left, before anything new", async () => {
    const storage = memoryStorage();
    await storage.add([{ imageId: 5, decision: decision("old") }]);
    const { outbox, sent } = outboxTo(() => undefined, storage);
    const restored = outbox.restore();
    outbox.add(5, [decision("new")]);
    await restored;
    await outbox.flush();
    expect(sent.flatMap((batch) => batch.ids)).toEqual(["old", "new"]);
    expect(await storage.all()).toEqual([]);
  });

  it("finds the one refused decision and stores all others", async () => {
    const { outbox, sent } = outboxTo((_, ids) => {
      if (ids.includes("bad")) throw refusal();
    });
    outbox.add(1, ["a", "b", "bad", "c", "d"].map(decision));
    await outbox.flush();
    expect(sent.flatMap((batch) => batch.ids)).toEqual(["a", "b", "c", "d"]);
    const state = outbox.getState();
    expect(state.kind === "refused" && state.refused.map((entry) => entry.decision.client_id)).toEqual([
      "bad",
    ]);
    outbox.dismissRefused();
    expect(outbox.getState()).toEqual({ kind: "saved" });
  });

  it("works without a storage", async () => {
    const broken = () => Promise.reject(new Error("storage is forbidden"));
    const { outbox, sent } = outboxTo(() => undefined, { all: broken, add: broken, remove: broken });
    await outbox.restore();
    outbox.add(1, [decision("a")]);
    await outbox.flush();
    expect(sent).toHaveLength(1);
  });

  it("knows what is pending for an image", () => {
    const { outbox } = outboxTo(() => undefined);
    outbox.add(1, [decision("a")]);
    outbox.add(2, [decision("b")]);
    expect(outbox.pendingFor(2).map((entry) => entry.client_id)).toEqual(["b"]);
  });
});
