/**
 * Runs something once the next frame is on the screen, unless the returned function is called before: what matters
 * less than the answer to a key doesn't hold it up.
 */
export function afterNextFrame(act: () => void): () => void {
  let timer: ReturnType<typeof setTimeout> | null = null;
  const frame = requestAnimationFrame(() => {
    timer = setTimeout(act);
  });
  return () => {
    cancelAnimationFrame(frame);
    if (timer !== null) clearTimeout(timer);
  };
}
