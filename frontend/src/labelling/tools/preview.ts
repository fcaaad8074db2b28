/** What the tool in hand would do if the drag ended now. */

import type { Verdict } from "../../api/types";

export interface Touched {
  readonly indices: ReadonlySet<number>;
  /** The verdict that they would get; null: they would be selected. */
  readonly verdict: Verdict | null;
}

export const NOTHING_TOUCHED: Touched = { indices: new Set(), verdict: null };

/** Kept apart from the candidates' state: a stroke changes it many times a second, and only the image shows it. */
export class Preview {
  private readonly listeners = new Set<() => void>();
  private touched: Touched = NOTHING_TOUCHED;

  readonly get = (): Touched => this.touched;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  show(indices: Iterable<number>, verdict: Verdict | null): void {
    const next = new Set(indices);
    if (verdict === this.touched.verdict && sameSet(next, this.touched.indices)) return;
    this.set({ indices: next, verdict });
  }

  clear(): void {
    if (this.touched !== NOTHING_TOUCHED) this.set(NOTHING_TOUCHED);
  }

  private set(touched: Touched): void {
    this.touched = touched;
    for (const listener of [...this.listeners]) listener();
  }
}

/** The lines that look different between two previews. */
export function changedBetween(before: Touched, after: Touched): number[] {
  if (before.verdict !== after.verdict) return [...new Set([...before.indices, ...after.indices])];
  const gone = [...before.indices].filter((index) => !after.indices.has(index));
  return [...gone, ...[...after.indices].filter((index) => !before.indices.has(index))];
}

function sameSet(a: ReadonlySet<number>, b: ReadonlySet<number>): boolean {
  return a.size === b.size && [...a].every((index) => b.has(index));
}
