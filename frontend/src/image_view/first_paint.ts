/** Lets what is needed later wait until an image is seen: on a small machine it would take the time from it. */

import { afterNextFrame } from "./after_next_frame";

/** An image that can't be shown holds nothing up for longer (ms). */
const PATIENCE = 3_000;

export class FirstPaint {
  private seen: number | null = null;
  private readonly waiting = new Map<number, Set<() => void>>();

  /** Image and lines have been drawn. */
  painted(imageId: number): void {
    this.seen = imageId;
    const calls = this.waiting.get(imageId);
    this.waiting.delete(imageId);
    // Once the frame that was drawn is on the screen.
    for (const call of calls ?? []) afterNextFrame(call);
  }

  /** Resolves once the image is seen, or doesn't come; at once where it is the one that was drawn last. */
  whenPainted(imageId: number): Promise<void> {
    if (this.seen === imageId) return Promise.resolve();
    return new Promise((resolve) => {
      const calls = this.waiting.get(imageId) ?? new Set();
      this.waiting.set(imageId, calls.add(resolve));
      setTimeout(() => {
        calls.delete(resolve);
        if (calls.size === 0 && this.waiting.get(imageId) === calls) this.waiting.delete(imageId);
        resolve();
      }, PATIENCE);
    });
  }
}

export const firstPaint = new FirstPaint();
