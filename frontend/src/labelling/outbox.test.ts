import { describe, expect, it } from "vitest";
import { RequestFailed, unreachable } from "../api/problem";
import type { DecisionsStored, NewDecision } from "../api/types";
import { Outbox, type SaveState } from "./outbox";
import { memoryStorage, type OutboxStorage } from "./outbox_storage";

const ANSWER: DecisionsStored = {
  stored: 1,
  repeated: 0,
  verdicts: { undecided: 0, keep: 0, reject: 0, ambiguous: 0 },
  status: "open",
  last_decision_id: 1,
  others: [],
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
  patience: () => Promise<void> = () => new Promise(() => undefined),
) {
  const sent: Sent[] = [];
  let waits = 0;
  const outbox = new Outbox({
    storage,
    wait: async () => {
      waits++;
    },
    patience,
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
    const storage = { lasting: true, all: broken, add: broken, remove: broken };
    const { outbox, sent } = outboxTo(() => undefined, storage);
    await outbox.restore();
    outbox.add(1, [decision("a")]);
    await outbox.flush();
    expect(sent).toHaveLength(1);
  });

  it("says what a reload would lose, and no longer than it would", async () => {
    const broken = () => Promise.reject(new Error("storage is full"));
    const states: SaveState[] = [];
    let down = true;
    const { outbox } = outboxTo(
      () => {
        if (!down) return;
        down = false;
        throw unreachable();
      },
      { ...memoryStorage(), lasting: true, add: broken },
    );
    outbox.subscribe(() => states.push(outbox.getState()));
    outbox.add(1, [decision("a")]);
    await Promise.resolve();
    await settled(outbox);
    expect(states).toContainEqual(expect.objectContaining({ kind: "offline", waiting: 1, kept: "lost" }));
    expect(outbox.atRisk).toBe(false);
  });

  it("says that a decision is kept only once the browser has stored it", async () => {
    let finish: () => void = () => undefined;
    const storing = new Promise<void>((resolve) => {
      finish = resolve;
    });
    const states: SaveState[] = [];
    let down = true;
    const { outbox } = outboxTo(
      () => {
        if (!down) return;
        down = false;
        throw unreachable();
      },
      { ...memoryStorage(), lasting: true, add: () => storing },
    );
    outbox.add(1, [decision("a")]);
    expect(outbox.atRisk).toBe(true);
    outbox.subscribe(() => states.push(outbox.getState()));
    finish();
    await settled(outbox);
    expect(states).toContainEqual(expect.objectContaining({ kind: "offline", waiting: 1, kept: "kept" }));
    expect(outbox.atRisk).toBe(false);
  });

  it("sends although the storage never answers", async () => {
    const silent = () => new Promise<never>(() => undefined);
    const storage = { lasting: true, all: silent, add: silent, remove: silent };
    const { outbox, sent } = outboxTo(
      () => undefined,
      storage,
      () => Promise.resolve(),
    );
    await outbox.restore();
    outbox.add(1, [decision("a")]);
    await outbox.flush();
    expect(sent).toEqual([{ imageId: 1, ids: ["a"] }]);
  });

  it("takes up what was left once the server says again which database it serves", async () => {
    const left = memoryStorage();
    await left.add([{ imageId: 3, decision: decision("old") }]);
    let asked = 0;
    const all = () => (++asked === 1 ? Promise.reject(unreachable()) : left.all());
    const { outbox, sent } = outboxTo(() => undefined, { ...left, all });
    await outbox.restore();
    while (sent.length === 0) await Promise.resolve();
    expect(sent).toEqual([{ imageId: 3, ids: ["old"] }]);
  });

  it("knows what is pending for an image", () => {
    const { outbox } = outboxTo(() => undefined);
    outbox.add(1, [decision("a")]);
    outbox.add(2, [decision("b")]);
    expect(outbox.pendingFor(2).map((entry) => entry.client_id)).toEqual(["b"]);
  });
});
