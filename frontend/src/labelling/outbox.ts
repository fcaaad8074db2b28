/**
 * Decisions on their way to the server.
 *
 * Each one is stored in the browser before the network is tried, sent in order, and forgotten once the server
 * has acknowledged it. Sending twice is harmless: the server knows a decision by its client id.
 */

import { asProblem, RequestFailed } from "../api/problem";
import type { DecisionsStored, NewDecision, Problem } from "../api/types";
import type { OutboxEntry, OutboxStorage } from "./outbox_storage";
import { type StaleDecision, seenByNow, sortedOut } from "./people/stale_decisions";

/** The server's limit is 5,000; smaller batches keep a bad connection moving. */
const BATCH = 500;
const FIRST_WAIT = 400;
const LONGEST_WAIT = 10_000;
/** A browser's storage that doesn't answer for so long (ms) must not keep a decision from the server. */
const STORAGE_PATIENCE = 1_500;

/** Whether what waits survives a reload: it does, it will in a moment, or this browser keeps nothing. */
export type Kept = "kept" | "storing" | "lost";

export type SaveState =
  | { readonly kind: "saved" }
  | { readonly kind: "saving"; readonly waiting: number }
  | {
      readonly kind: "offline";
      readonly waiting: number;
      readonly problem: Problem;
      readonly kept: Kept;
    }
  | { readonly kind: "stale"; readonly stale: readonly StaleDecision[] }
  | { readonly kind: "refused"; readonly refused: readonly RefusedDecision[] };

export interface RefusedDecision extends OutboxEntry {
  readonly problem: Problem;
}

interface OutboxParts {
  storage: OutboxStorage;
  send: (imageId: number, decisions: NewDecision[], seen: number | null) => Promise<DecisionsStored>;
  /** Resolves after some milliseconds, earlier when the network comes back. */
  wait: (milliseconds: number) => Promise<void>;
  /** Resolves after some milliseconds, whatever the network does. */
  patience: (milliseconds: number) => Promise<void>;
  onStored?: (imageId: number, answer: DecisionsStored) => void;
}

export class Outbox {
  private readonly parts: OutboxParts;
  private queue: OutboxEntry[] = [];
  private refused: RefusedDecision[] = [];
  /** Kept in the browser until the person has said whose verdict stands. */
  private stale: readonly StaleDecision[] = [];
  private problem: Problem | null = null;
  private pumping: Promise<void> | null = null;
  /** Settles once the browser's storage has what was added last, or has kept silent for too long. */
  private stored: Promise<void> = Promise.resolve();
  /** What the next transaction of the storage takes with it. */
  private toStore: OutboxEntry[] | null = null;
  /** Each transaction that hasn't succeeded, with what its entries are meanwhile. */
  private readonly unkept = new Map<readonly OutboxEntry[], Kept>();
  private restored: Promise<void> = Promise.resolve();
  private state: SaveState = { kind: "saved" };
  private endPause: () => void = () => undefined;
  private readonly listeners = new Set<() => void>();

  constructor(parts: OutboxParts) {
    this.parts = parts;
  }

  readonly getState = (): SaveState => this.state;

  /** What waits for an answer whose verdict stands; the same list until it changes. */
  readonly getStale = (): readonly StaleDecision[] => this.stale;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  /** Takes up what an earlier visit left unsent; nothing new is sent before it. */
  restore(): Promise<void> {
    this.restored = Promise.race([this.takeUp(), this.parts.patience(STORAGE_PATIENCE)]);
    return this.restored;
  }

  /** @param seen The image's last decision that the person knows. */
  add(imageId: number, decisions: readonly NewDecision[], seen: number | null = null): void {
    const entries = decisions.map((decision) => ({ imageId, decision, seen }));
    const judged = new Set(decisions.map((decision) => decision.segment_id));
    // A new verdict is the answer to the question whose stands.
    this.takeTheirs(
      this.stale.filter((entry) => entry.imageId === imageId && judged.has(entry.decision.segment_id)),
    );
    this.queue = [...this.queue, ...entries];
    this.store(entries);
    this.pump();
  }

  /** True where a reload would lose something. */
  get atRisk(): boolean {
    return this.queue.length > 0 && this.kept !== "kept";
  }

  /** Tries at once instead of after the pause that a failure brings. */
  retry(): void {
    this.endPause();
  }

  /** Resolves once what an earlier visit left is known here. */
  get ready(): Promise<void> {
    return this.restored;
  }

  /** Decisions of an image that the server hasn't acknowledged, oldest first. */
  pendingFor(imageId: number): NewDecision[] {
    return this.queue.filter((entry) => entry.imageId === imageId).map((entry) => entry.decision);
  }

  /**
   * Resolves once the server has everything.
   *
   * @throws RequestFailed when a sending fails; it is retried all the same.
   */
  flush(): Promise<void> {
    return new Promise((resolve, reject) => {
      const settle = () => {
        if (this.state.kind === "saving") return;
        stop();
        if (this.state.kind === "offline") reject(new RequestFailed(this.state.problem));
        else resolve();
      };
      const stop = this.subscribe(settle);
      settle();
    });
  }

  /** Sends decisions again, by someone who knows the other person's verdict. */
  keepMine(stale: readonly StaleDecision[]): void {
    this.stale = this.stale.filter((entry) => !stale.includes(entry));
    this.queue = [...this.queue, ...seenByNow(stale)];
    this.pump();
  }

  /** Forgets decisions: the other person's verdicts stand. */
  takeTheirs(stale: readonly StaleDecision[]): void {
    if (stale.length === 0) return;
    this.stale = this.stale.filter((entry) => !stale.includes(entry));
    this.forget(stale);
    this.update();
  }

  /** The person has read what was refused. */
  dismissRefused(): void {
    this.refused = [];
    this.update();
  }

  private get kept(): Kept {
    const all = [...this.unkept.values()];
    if (all.includes("lost")) return "lost";
    return all.length > 0 ? "storing" : "kept";
  }

  /** One transaction at a time: what comes in meanwhile goes with the next, so a slow disk falls behind by two. */
  private store(entries: readonly OutboxEntry[]): void {
    if (this.toStore !== null) {
      this.toStore.push(...entries);
      return;
    }
    const batch = [...entries];
    this.toStore = batch;
    this.unkept.set(batch, "storing");
    this.stored = this.stored.then(() => {
      this.toStore = null;
      return this.transact(batch);
    });
  }

  /** A full, forbidden or silent storage must not keep a decision from the server. */
  private async transact(batch: readonly OutboxEntry[]): Promise<void> {
    const { storage, patience } = this.parts;
    const settle = (kept: boolean) => {
      if (!this.unkept.has(batch)) return;
      if (kept) this.unkept.delete(batch);
      else this.unkept.set(batch, "lost");
      this.update();
    };
    const storing = storage.add(batch).then(
      () => settle(storage.lasting),
      () => settle(false),
    );
    const silent = patience(STORAGE_PATIENCE).then(() => settle(false));
    await Promise.race([storing, silent]);
  }

  private async takeUp(): Promise<void> {
    const { storage, wait } = this.parts;
    const left = await storage.all().catch((error: unknown) => {
      // Which database's decisions are meant is asked of the server: it may only be away for a moment.
      if (error instanceof RequestFailed && error.temporary) wait(LONGEST_WAIT).then(() => this.takeUp());
      return [];
    });
    const known = new Set([...this.queue, ...this.stale].map((entry) => entry.decision.client_id));
    this.queue = [...left.filter((entry) => !known.has(entry.decision.client_id)), ...this.queue];
    this.pump();
  }

  private pump(): void {
    this.update();
    if (this.pumping !== null || this.queue.length === 0) return;
    this.pumping = this.sendAll().finally(() => {
      this.pumping = null;
      // A decision may have come in after the last look at the queue.
      if (this.queue.length > 0) this.pump();
    });
  }

  private async sendAll(): Promise<void> {
    await this.restored;
    let pause = FIRST_WAIT;
    while (this.queue.length > 0) {
      await this.stored;
      try {
        await this.sendBatch(this.nextBatch());
        this.problem = null;
        pause = FIRST_WAIT;
      } catch (error) {
        this.problem = asProblem(error);
        this.update();
        await Promise.race([
          this.parts.wait(pause),
          new Promise<void>((resolve) => {
            this.endPause = resolve;
          }),
        ]);
        pause = Math.min(2 * pause, LONGEST_WAIT);
      }
      this.update();
    }
  }

  private nextBatch(): OutboxEntry[] {
    const [first] = this.queue;
    const end = this.queue.findIndex(
      (entry) => entry.imageId !== first?.imageId || seenOf(entry) !== seenOf(first),
    );
    return this.queue.slice(0, Math.min(end < 0 ? this.queue.length : end, BATCH));
  }

  /** A batch is stored whole or not at all, so one refused decision is found by halving. */
  private async sendBatch(batch: OutboxEntry[]): Promise<void> {
    const first = batch[0];
    if (first === undefined) return;
    try {
      const answer = await this.parts.send(
        first.imageId,
        batch.map((entry) => entry.decision),
        seenOf(first),
      );
      this.forget(batch);
      this.parts.onStored?.(first.imageId, answer);
    } catch (error) {
      if (!(error instanceof RequestFailed) || error.temporary) throw error;
      const { stale, rest } = sortedOut(batch, error.problem);
      if (stale.length > 0) {
        this.holdBack(stale);
        await this.sendBatch(rest);
        return;
      }
      if (batch.length === 1) {
        this.refused = [...this.refused, { ...first, problem: error.problem }];
        this.forget(batch);
        return;
      }
      const half = Math.ceil(batch.length / 2);
      await this.sendBatch(batch.slice(0, half));
      await this.sendBatch(batch.slice(half));
    }
  }

  /** What is stale isn't sent again by itself, and isn't lost either. */
  private holdBack(stale: readonly StaleDecision[]): void {
    const ids = new Set(stale.map((entry) => entry.decision.client_id));
    this.queue = this.queue.filter((entry) => !ids.has(entry.decision.client_id));
    this.stale = [...this.stale, ...stale];
    this.update();
  }

  private forget(batch: readonly OutboxEntry[]): void {
    const ids = batch.map((entry) => entry.decision.client_id);
    const gone = new Set(ids);
    this.queue = this.queue.filter((entry) => !gone.has(entry.decision.client_id));
    if (this.queue.length === 0) this.unkept.clear();
    // If this fails, the entries are sent once more at the next visit, and recognised there.
    this.parts.storage.remove(ids).catch(() => undefined);
  }

  private update(): void {
    this.state = this.currentState();
    for (const listener of [...this.listeners]) listener();
  }

  private currentState(): SaveState {
    const waiting = this.queue.length;
    if (waiting > 0 && this.problem !== null) {
      return { kind: "offline", waiting, problem: this.problem, kept: this.kept };
    }
    if (waiting > 0) return { kind: "saving", waiting };
    if (this.stale.length > 0) return { kind: "stale", stale: this.stale };
    if (this.refused.length > 0) return { kind: "refused", refused: this.refused };
    return { kind: "saved" };
  }
}

function seenOf(entry: OutboxEntry): number | null {
  return entry.seen ?? null;
}
