/** Files on their way to datasets: a few requests at a time, each file with its own state. */

import { asProblem } from "../api/problem";
import type { ErrorInfo, UploadReport } from "../api/types";
import type { FileToSend, SendOptions } from "../api/upload";
import { type BatchLimits, makeBatches } from "./batches";
import { Speed } from "./speed";
import { failuresOf, outcomesOf } from "./upload_outcome";

export type UploadState = "waiting" | "sending" | "added" | "existing" | "failed" | "cancelled";

export interface UploadItem {
  readonly id: number;
  readonly slug: string;
  readonly path: string;
  readonly size: number;
  /** Absent for a file inside a zip, which can't be sent again alone. */
  readonly file: File | null;
  state: UploadState;
  sent: number;
  error: Pick<ErrorInfo, "message" | "hint"> | null;
}

export interface UploadSnapshot {
  readonly items: readonly Readonly<UploadItem>[];
  readonly counts: Readonly<Record<UploadState, number>>;
  readonly bytes: number;
  readonly sent: number;
  readonly bytesPerSecond: number;
  readonly active: boolean;
}

export interface UploadDependencies {
  send: (slug: string, files: readonly FileToSend[], options: SendOptions) => Promise<UploadReport>;
  now: () => number;
  limits: BatchLimits;
  /** Requests at a time. */
  parallel: number;
  onStored: (slug: string, report: UploadReport) => void;
}

interface Batch {
  slug: string;
  items: UploadItem[];
  abort: AbortController;
}

const NOTHING: UploadSnapshot = {
  items: [],
  counts: { waiting: 0, sending: 0, added: 0, existing: 0, failed: 0, cancelled: 0 },
  bytes: 0,
  sent: 0,
  bytesPerSecond: 0,
  active: false,
};

export class UploadQueue {
  private readonly dependencies: UploadDependencies;
  private readonly listeners = new Set<() => void>();
  private items: UploadItem[] = [];
  private waiting: Batch[] = [];
  private running = new Set<Batch>();
  private speed = new Speed();
  private nextId = 1;
  private current: UploadSnapshot = NOTHING;

  constructor(dependencies: UploadDependencies) {
    this.dependencies = dependencies;
  }

  get snapshot(): UploadSnapshot {
    return this.current;
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  add(slug: string, files: readonly FileToSend[]): void {
    if (!this.current.active) this.speed = new Speed();
    const added = files.map(({ file, path }) => this.item(slug, path, file));
    this.items.push(...added);
    this.enqueue(added);
  }

  /** Sends what failed or was cancelled once more. */
  retry(): void {
    const again = this.items.filter(
      (item) => item.file && (item.state === "failed" || item.state === "cancelled"),
    );
    for (const item of again) Object.assign(item, { state: "waiting", sent: 0, error: null });
    this.enqueue(again);
  }

  /** Stops what is under way. What has arrived stays. */
  cancel(): void {
    for (const batch of this.waiting) for (const item of batch.items) item.state = "cancelled";
    this.waiting = [];
    for (const batch of this.running) batch.abort.abort();
    this.changed();
  }

  /** Forgets what is over. */
  clear(): void {
    this.items = this.items.filter((item) => item.state === "waiting" || item.state === "sending");
    this.changed();
  }

  private item(slug: string, path: string, file: File | null): UploadItem {
    return {
      id: this.nextId++,
      slug,
      path,
      size: file?.size ?? 0,
      file,
      state: "waiting",
      sent: 0,
      error: null,
    };
  }

  private enqueue(items: readonly UploadItem[]): void {
    for (const slug of new Set(items.map((item) => item.slug))) {
      const ofDataset = items.filter((item) => item.slug === slug);
      for (const batch of makeBatches(ofDataset, this.dependencies.limits)) {
        this.waiting.push({ slug, items: batch, abort: new AbortController() });
      }
    }
    this.fill();
    this.changed();
  }

  private fill(): void {
    while (this.running.size < this.dependencies.parallel) {
      const batch = this.waiting.shift();
      if (!batch) return;
      this.running.add(batch);
      void this.run(batch).finally(() => {
        this.running.delete(batch);
        this.fill();
        this.changed();
      });
    }
  }

  private async run(batch: Batch): Promise<void> {
    for (const item of batch.items) item.state = "sending";
    const files = batch.items.flatMap(({ file, path }) => (file ? [{ file, path }] : []));
    try {
      const report = await this.dependencies.send(batch.slug, files, {
        signal: batch.abort.signal,
        onProgress: (sent, total) => this.progressed(batch, sent, total),
      });
      this.settle(batch, report);
      this.dependencies.onStored(batch.slug, report);
    } catch (error) {
      this.fail(batch, error);
    }
  }

  private settle(batch: Batch, report: UploadReport): void {
    const { byPath, inside } = outcomesOf(
      batch.items.map((item) => item.path),
      report,
    );
    for (const item of batch.items) {
      const outcome = byPath.get(item.path);
      item.state = outcome?.state ?? "added";
      item.error = outcome?.error ?? null;
      item.sent = item.size;
    }
    for (const { path, error } of inside) {
      this.items.push({ ...this.item(batch.slug, path, null), state: "failed", error });
    }
  }

  private fail(batch: Batch, error: unknown): void {
    const cancelled = error instanceof DOMException && error.name === "AbortError";
    const problem = asProblem(error);
    const each = failuresOf(problem);
    for (const item of batch.items) {
      item.state = cancelled ? "cancelled" : "failed";
      item.error = cancelled ? null : (each.get(item.path) ?? problem);
    }
  }

  /** A request's files are sent one after the other, so the bytes sent tell how far each is. */
  private progressed(batch: Batch, sent: number, total: number): void {
    const size = batch.items.reduce((sum, item) => sum + item.size, 0);
    let left = total > 0 ? (sent / total) * size : 0;
    for (const item of batch.items) {
      item.sent = Math.min(item.size, left);
      left -= item.sent;
    }
    this.changed();
  }

  private changed(): void {
    const counts = { ...NOTHING.counts };
    let [bytes, sent] = [0, 0];
    for (const item of this.items) {
      counts[item.state] += 1;
      bytes += item.size;
      sent += item.state === "failed" || item.state === "cancelled" ? item.size : item.sent;
    }
    this.speed.record(this.dependencies.now(), sent);
    const active = this.running.size > 0 || this.waiting.length > 0;
    const bytesPerSecond = active ? this.speed.bytesPerSecond : 0;
    this.current = { items: [...this.items], counts, bytes, sent, bytesPerSecond, active };
    for (const listener of this.listeners) listener();
  }
}
