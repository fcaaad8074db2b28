/** What the tool in hand would do if the drag ended now. */

import type { Verdict } from "../../api/types";

/** By candidate, the verdict that it would get; null: it would be selected. */
export type Touched = ReadonlyMap<number, Verdict | null>;

export const NOTHING_TOUCHED: Touched = new Map();

/** Kept apart from the candidates' state: a stroke changes it many times a second, and only the image shows it. */
export class Preview {
  private readonly listeners = new Set<() => void>();
  private touched: Touched = NOTHING_TOUCHED;

  readonly get = (): Touched => this.touched;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  show(touched: Touched): void {
    if (changedBetween(this.touched, touched).length > 0) this.set(touched);
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
  const gone = [...before.keys()].filter((index) => !after.has(index));
  const others = [...after].filter(([index, verdict]) => before.get(index) !== verdict);
  return [...gone, ...others.map(([index]) => index)];
}
