/** The edge between an image before and after, as a share of its place's width. */

const STEP = 0.02;
const LARGE_STEP = 0.1;

/** Where a key moves the edge; null where it doesn't. */
export function edgeAfterKey(key: string, share: number, large: boolean): number | null {
  const step = large ? LARGE_STEP : STEP;
  const moved: Record<string, number> = {
    ArrowLeft: share - step,
    ArrowDown: share - step,
    ArrowRight: share + step,
    ArrowUp: share + step,
    PageDown: share - LARGE_STEP,
    PageUp: share + LARGE_STEP,
    Home: 0,
    End: 1,
  };
  const next = moved[key];
  // Rounded, so that steps to and fro lead back to where they began.
  return next === undefined ? null : Math.round(1e4 * Math.min(1, Math.max(0, next))) / 1e4;
}

/** "40 % before, 60 % after". */
export function edgeText(share: number): string {
  const before = Math.round(100 * share);
  if (before === 0) return "After only";
  if (before === 100) return "Before only";
  return `${before} % before, ${100 - before} % after`;
}
