/** Movements of the view that nobody made by hand: short, and along a straight way, so that the eye can follow. */

import { clamp } from "./geometry";
import { centreOn, type Size, toImage, type Viewport } from "./viewport";

/** How long a movement takes (ms). */
const DURATION = 140;

/** The viewport at a share (0 to 1) of the way between two. */
export function between(from: Viewport, to: Viewport, share: number, screen: Size): Viewport {
  if (share >= 1) return to;
  const middle = { x: screen.width / 2, y: screen.height / 2 };
  const start = toImage(from, middle.x, middle.y);
  const end = toImage(to, middle.x, middle.y);
  // What is seen of the image grows or shrinks evenly: 1 / scale is its size.
  const scale = 1 / (1 / from.scale + (1 / to.scale - 1 / from.scale) * share);
  return centreOn(
    { x: start.x + (end.x - start.x) * share, y: start.y + (end.y - start.y) * share },
    scale,
    screen,
  );
}

/** Fast at first, slow at the end. */
export function eased(share: number): number {
  return 1 - (1 - clamp(share, 0, 1)) ** 3;
}

/** Calls `move` with the share of the way in each display frame until it is 1, or until the function given is called. */
export function glide(move: (share: number) => void): () => void {
  if (window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
    move(1);
    return () => undefined;
  }
  const start = performance.now();
  let frame = requestAnimationFrame(step);
  function step(now: number): void {
    const share = eased((now - start) / DURATION);
    if (share < 1) frame = requestAnimationFrame(step);
    move(share);
  }
  return () => cancelAnimationFrame(frame);
}
