/** How fast bytes go, over the last few seconds. */
export class Speed {
  private readonly samples: { time: number; bytes: number }[] = [];
  private readonly windowMs: number;

  constructor(windowMs = 4_000) {
    this.windowMs = windowMs;
  }

  /** @param time in ms, @param bytes sent in all until then. */
  record(time: number, bytes: number): void {
    this.samples.push({ time, bytes });
    while (this.samples.length > 2 && time - (this.samples[0]?.time ?? time) > this.windowMs)
      this.samples.shift();
  }

  /** Bytes per second; 0 while there is too little to tell. */
  get bytesPerSecond(): number {
    const first = this.samples[0];
    const last = this.samples.at(-1);
    if (!first || !last || last.time - first.time < 200) return 0;
    return Math.max(0, (1000 * (last.bytes - first.bytes)) / (last.time - first.time));
  }
}
