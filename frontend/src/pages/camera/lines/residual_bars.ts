/** A histogram of residuals. */

import type { Bar } from "../../../charts/bars";
import { ticks } from "../../../charts/scale";

const BARS = 24;
/** Share of the lines that the last bar gathers at most: one far off would squeeze all others into a corner. */
const TAIL = 0.01;

/** @param residuals px. */
export function residualBars(residuals: readonly number[]): Bar[] {
  const sorted = residuals.filter(Number.isFinite).sort((a, b) => a - b);
  if (sorted.length === 0) return [];
  const highest = sorted[Math.min(sorted.length - 1, Math.ceil((1 - TAIL) * sorted.length))] ?? 0;
  const marks = ticks([0, Math.max(highest, 1e-3)], BARS);
  const step = (marks[1] ?? 1) - (marks[0] ?? 0);
  const count = Math.max(1, Math.ceil(highest / step + 1e-9));
  const bins = Array.from({ length: count }, () => 0);
  for (const value of sorted) {
    const bin = Math.min(count - 1, Math.floor(value / step + 1e-9));
    bins[bin] = (bins[bin] ?? 0) + 1;
  }
  return bins.map((value, index) => {
    const from = short(index * step);
    const last = index === count - 1 && (sorted.at(-1) ?? 0) > (index + 1) * step;
    return {
      label: from,
      name: last ? `${from} px and more` : `${from} to ${short((index + 1) * step)} px`,
      value,
    };
  });
}

function short(value: number): string {
  return String(Number(value.toPrecision(3)));
}
