/** Keeps telling the server that a page has an image open, and knows who else has. */

import type { LeaseState } from "../../api/people_endpoints";

/** A lease lasts 60 s: two renewals may fail before it ends. */
export const RENEW_EVERY = 20_000;

interface LeaseParts {
  renew: (takeOver: boolean) => Promise<LeaseState>;
  drop: () => void;
  /** Calls again and again after so many milliseconds, until the returned function is called. */
  every: (milliseconds: number, act: () => void) => () => void;
}

export class LeaseKeeper {
  private readonly parts: LeaseParts;
  private readonly listeners = new Set<() => void>();
  private state: LeaseState | null = null;
  private stopRenewing: (() => void) | null = null;
  /** Answers of earlier requests than the last one that was answered say nothing new. */
  private asked = 0;
  private answered = 0;

  constructor(parts: LeaseParts) {
    this.parts = parts;
  }

  /** Null until the server has answered once; then its latest answer, also while it is away. */
  readonly getState = (): LeaseState | null => this.state;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  start(): void {
    if (this.stopRenewing !== null) return;
    this.stopRenewing = this.parts.every(RENEW_EVERY, () => this.renew());
    this.renew();
  }

  /** Leaves the image at once. */
  stop(): void {
    if (this.stopRenewing === null) return;
    this.stopRenewing();
    this.stopRenewing = null;
    this.parts.drop();
  }

  /** Asks for the image although another person holds it. */
  takeOver(): Promise<void> {
    return this.renew(true);
  }

  /** Tells the server now; that it doesn't answer is said elsewhere. */
  async renew(takeOver = false): Promise<void> {
    this.asked += 1;
    const number = this.asked;
    const state = await this.parts.renew(takeOver).catch(() => null);
    if (state === null || number < this.answered || this.stopRenewing === null) return;
    this.answered = number;
    if (this.state !== null && isAlone(this.state) && isAlone(state)) return;
    this.state = state;
    for (const listener of [...this.listeners]) listener();
  }
}

/** Nobody else is there: that it is so for another minute is no news. */
function isAlone({ holder, present }: LeaseState): boolean {
  return holder?.mine === true && present.every((each) => each.mine);
}

/** Whether the page may decide: nobody else holds the image, as far as is known. */
export function mayDecide(state: LeaseState | null): boolean {
  return state?.holder?.mine !== false;
}
