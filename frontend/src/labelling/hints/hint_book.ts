/** A person's experience, kept in this browser. */

import { type Experience, HINTS, type HintId, NEWCOMER } from "./hints";

const STORAGE_KEY = "clearlines.hints";
/** No hint waits for more judgements. */
const ENOUGH = Math.max(...HINTS.map(({ after }) => after));

export class HintBook {
  private readonly storage: Storage;
  private readonly listeners = new Set<() => void>();
  private experience: Experience;

  constructor(storage: Storage) {
    this.storage = storage;
    this.experience = this.read();
  }

  readonly getState = (): Experience => this.experience;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  judged(): void {
    if (this.experience.judged < ENOUGH) this.set({ judged: this.experience.judged + 1 });
  }

  /** It was used, or waved away: it isn't told again. */
  learnt(id: HintId): void {
    const { known } = this.experience;
    if (!known.includes(id)) this.set({ known: [...known, id] });
  }

  private set(part: Partial<Experience>): void {
    this.experience = { ...this.experience, ...part };
    try {
      this.storage.setItem(STORAGE_KEY, JSON.stringify(this.experience));
    } catch {
      // Storage may be full or forbidden; what was learnt then lasts as long as the page.
    }
    for (const listener of [...this.listeners]) listener();
  }

  private read(): Experience {
    try {
      const stored = JSON.parse(this.storage.getItem(STORAGE_KEY) ?? "{}") as Partial<Experience>;
      const known = Array.isArray(stored.known) ? stored.known : [];
      return {
        judged: Number.isInteger(stored.judged) ? (stored.judged ?? 0) : 0,
        known: HINTS.map(({ id }) => id).filter((id) => known.includes(id)),
      };
    } catch {
      return NEWCOMER;
    }
  }
}
