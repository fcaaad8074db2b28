import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FirstPaint } from "./first_paint";

const FRAME = 16;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("requestAnimationFrame", (call: () => void) => setTimeout(call, FRAME));
});

afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

async function isOver(promise: Promise<void>): Promise<boolean> {
  let over = false;
  promise.then(() => {
    over = true;
  });
  await vi.advanceTimersByTimeAsync(0);
  return over;
}

describe("what waits for an image to be seen", () => {
  it("goes on once that image is drawn, not another one", async () => {
    const paint = new FirstPaint();
    const seen = [paint.whenPainted(7), paint.whenPainted(7)] as const;
    paint.painted(6);
    expect(await isOver(seen[0])).toBe(false);
    paint.painted(7);
    // The frame itself comes first.
    expect(await isOver(seen[0])).toBe(false);
    await vi.advanceTimersByTimeAsync(FRAME + 1);
    expect(await isOver(seen[0])).toBe(true);
    expect(await isOver(seen[1])).toBe(true);
  });

  it("doesn't wait while the image is on the screen, and does when it is opened again", async () => {
    const paint = new FirstPaint();
    paint.painted(7);
    expect(await isOver(paint.whenPainted(7))).toBe(true);
    paint.painted(8);
    expect(await isOver(paint.whenPainted(7))).toBe(false);
  });

  it("goes on without an image that can't be shown", async () => {
    const waiting = new FirstPaint().whenPainted(7);
    await vi.advanceTimersByTimeAsync(2_900);
    expect(await isOver(waiting)).toBe(false);
    await vi.advanceTimersByTimeAsync(200);
    expect(await isOver(waiting)).toBe(true);
  });
});
