/** One line on its way: clicked points, what was traced between them, and whether it could be saved. */

import { asProblem, RequestFailed } from "../../api/problem";
import type { Problem, Trace } from "../../api/types";
import type { Point } from "../../canvas/geometry";
import { MOST_CLICKS, withClick } from "./clicks";

/** How far beside a clicked point its edge may lie (screen px), and what the server takes (image px). */
const REACH = 8;
const LEAST_REACH = 2;
const MOST_REACH = 64;

export interface TraceState {
  /** Clicked points in the order of the edge (image px). */
  readonly clicks: readonly Point[];
  /** What was traced between them; with one point alone, between it and the pointer. */
  readonly trace: Trace | null;
  /** Why there is no trace, or why it couldn't be saved. */
  readonly problem: Problem | null;
  /** Whether the line is the one drawn, no edge being there. */
  readonly straight: boolean;
  readonly saving: boolean;
}

export type TraceRequest = (wanted: {
  points: [number, number][];
  reach: number;
  straight: boolean;
}) => Promise<Trace>;

interface SessionParts {
  readonly trace: TraceRequest;
  /** Stores the line; the id makes it the same line when it is sent again. */
  readonly save: (points: Trace["points"], clientId: string) => Promise<void>;
  /** Screen px per image px. */
  readonly scale: () => number;
  readonly newId: () => string;
}

const NOTHING: TraceState = { clicks: [], trace: null, problem: null, straight: false, saving: false };

export class TraceSession {
  private readonly parts: SessionParts;
  private readonly listeners = new Set<() => void>();
  private state: TraceState = NOTHING;
  /** The order of the state's clicks, for taking the latest one back. */
  private clicked: Point[] = [];
  private pointer: Point | null = null;
  /** Rises with everything that makes an answer that is still on its way out of date. */
  private version = 0;
  private running: Promise<void> | null = null;
  private clientId: string;

  constructor(parts: SessionParts) {
    this.parts = parts;
    this.clientId = parts.newId();
  }

  readonly getState = (): TraceState => this.state;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  click(at: Point): void {
    if (this.state.saving || this.state.clicks.length >= MOST_CLICKS) return;
    this.clicked.push(at);
    this.restart(withClick(this.state.clicks, at));
  }

  /** The pointer rests or moves there; null: it is elsewhere. */
  hover(at: Point | null): void {
    this.pointer = at;
    if (this.state.clicks.length !== 1 || this.state.saving) return;
    if (at !== null) this.ask();
    else this.set({ trace: null, problem: null });
  }

  /** Takes the point back that was clicked last; false where there is none. */
  removeLast(): boolean {
    const last = this.clicked.pop();
    if (last === undefined || this.state.saving) return false;
    this.restart(this.state.clicks.filter((click) => click !== last));
    return true;
  }

  /** Takes the line as drawn, no edge being there. */
  async keepStraight(): Promise<boolean> {
    if (this.state.clicks.length < 2) return false;
    this.restart(this.state.clicks, true);
    return this.accept();
  }

  /** Saves the line, once it is traced; false where it couldn't be, with everything as it was. */
  async accept(): Promise<boolean> {
    if (this.state.clicks.length < 2 || this.state.saving) return false;
    await this.settled();
    if (this.state.trace === null && this.isWorthAsking()) {
      this.ask();
      await this.settled();
    }
    const { trace } = this.state;
    if (trace === null) return false;
    this.set({ saving: true, problem: null });
    try {
      await this.parts.save(trace.points, this.clientId);
    } catch (error) {
      this.set({ saving: false, problem: asProblem(error) });
      // What was refused for good would be refused again under the same id.
      if (!(error instanceof RequestFailed) || !error.temporary) this.clientId = this.parts.newId();
      return false;
    }
    this.clear();
    return true;
  }

  clear(): void {
    this.clicked = [];
    this.restart([]);
  }

  private restart(clicks: readonly Point[], straight = false): void {
    this.version++;
    this.clientId = this.parts.newId();
    this.set({ ...NOTHING, clicks, straight });
    if (this.points().length > 1) this.ask();
  }

  /** A refusal stays one; without an answer it may have been the network. */
  private isWorthAsking(): boolean {
    return this.state.problem === null || this.state.problem.status === 0 || this.state.problem.status >= 500;
  }

  private points(): Point[] {
    const { clicks } = this.state;
    return clicks.length === 1 && this.pointer !== null ? [...clicks, this.pointer] : [...clicks];
  }

  private ask(): void {
    this.version++;
    this.running ??= this.run().finally(() => {
      this.running = null;
    });
  }

  private async settled(): Promise<void> {
    while (this.running !== null) await this.running;
  }

  /** One request at a time: of all that the pointer passed meanwhile only the last place counts. */
  private async run(): Promise<void> {
    for (let done = -1; done !== this.version; ) {
      done = this.version;
      const points = this.points();
      if (points.length < 2) return;
      const answer = await this.request(points).catch((error: unknown) => ({ problem: asProblem(error) }));
      // With two points or more, an answer for others is of no use; while the pointer moves, it shows the way.
      if (done !== this.version && this.state.clicks.length !== 1) continue;
      if (this.points().length < 2) return;
      if ("problem" in answer) this.set({ trace: null, problem: answer.problem });
      else this.set({ trace: answer, problem: null });
    }
  }

  private request(points: readonly Point[]): Promise<Trace> {
    const reach = Math.min(MOST_REACH, Math.max(LEAST_REACH, REACH / this.parts.scale()));
    return this.parts.trace({
      points: points.map(({ x, y }) => [x, y]),
      reach,
      straight: this.state.straight,
    });
  }

  private set(part: Partial<TraceState>): void {
    this.state = { ...this.state, ...part };
    for (const listener of [...this.listeners]) listener();
  }
}
