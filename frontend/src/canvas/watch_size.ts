/** How large the element is in which an image is shown. */

import type { Size } from "./viewport";

/**
 * Tells the size of an element (CSS px) and how many of the screen's pixels make one of them: at once, and whenever
 * either is another one, until the returned function is called.
 */
export function watchSize(host: HTMLElement, changed: (size: Size, ratio: number) => void): () => void {
  const controller = new AbortController();
  const { signal } = controller;
  const tell = () => {
    const box = host.getBoundingClientRect();
    const size = { width: Math.max(1, box.width), height: Math.max(1, box.height) };
    changed(size, window.devicePixelRatio || 1);
  };
  /** A window on another screen has other pixels in the same size. */
  const watchRatio = () => {
    const again = () => {
      tell();
      watchRatio();
    };
    window
      .matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`)
      .addEventListener("change", again, { once: true, signal });
  };
  const resizes = new ResizeObserver(tell);
  resizes.observe(host);
  tell();
  watchRatio();
  return () => {
    resizes.disconnect();
    controller.abort();
  };
}
