/** Measures how long a person looked before deciding; time in which the page was hidden doesn't count. */
export class Stopwatch {
  private startedAt: number;
  private hiddenAt: number | null = null;
  private readonly now: () => number;

  /** @param now Milliseconds of a clock that never jumps. */
  constructor(now: () => number) {
    this.now = now;
    this.startedAt = now();
  }

  restart(): void {
    this.startedAt = this.now();
    if (this.hiddenAt !== null) this.hiddenAt = this.startedAt;
  }

  /** Whole milliseconds since the last restart. */
  read(): number {
    return Math.max(0, Math.round((this.hiddenAt ?? this.now()) - this.startedAt));
  }

  hide(): void {
    this.hiddenAt ??= this.now();
  }

  show(): void {
    if (this.hiddenAt === null) return;
    this.startedAt += this.now() - this.hiddenAt;
    this.hiddenAt = null;
  }
}
