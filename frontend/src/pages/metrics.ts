/** Metrics as they are written: values, intervals, differences. */

import type { Measured } from "../api/board_types";
import type { Metric, MetricUnit } from "./metric";
import { METRIC_GROUPS } from "./metric_groups";

const BY_KEY = new Map(METRIC_GROUPS.flatMap(({ metrics }) => metrics).map((entry) => [entry.key, entry]));

/** What is known of a metric; one that the pages don't know is called by its key. */
export function metricOf(key: string): Metric {
  const name = key.replaceAll("_", " ");
  return BY_KEY.get(key) ?? { key, name, short: key, unit: "ratio", best: "higher", meaning: "" };
}

const DIGITS: Record<MetricUnit, number> = { share: 3, ratio: 3, px: 2, degrees: 2, count: 0 };

/** A value in the metric's unit: "0.612", "0.84 px", "1.20°"; a dash where there is none. */
export function metricText(key: string, value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  const { unit } = metricOf(key);
  const shown = unit === "degrees" ? (value * 180) / Math.PI : value;
  // toFixed writes small negative values as "-0.00".
  const text = shown.toFixed(DIGITS[unit]).replace(/^-(0\.?0*)$/, "$1");
  if (unit === "px") return `${text} px`;
  return unit === "degrees" ? `${text}°` : text;
}

/** "0.580 to 0.640"; empty where there is no interval. */
export function intervalText(key: string, measured: Pick<Measured, "low" | "high"> | undefined): string {
  if (!measured || measured.low === null || measured.high === null) return "";
  const low = metricText(key, measured.low).replace(/[ °].*$/, "");
  return `${low} to ${metricText(key, measured.high)}`;
}

/** A difference with its sign: "+0.021". */
export function differenceText(key: string, difference: number | null): string {
  if (difference === null) return "–";
  const text = metricText(key, difference);
  return difference > 0 && /[1-9]/.test(text) ? `+${text}` : text;
}

/** True where a larger value of the first is to its advantage; null where neither end is best. */
export function isBetter(key: string, difference: number): boolean | null {
  const { best } = metricOf(key);
  if (best === "higher") return difference > 0;
  return best === "lower" ? difference < 0 : null;
}
