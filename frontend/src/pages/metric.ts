/** What the pages know of a metric. */

export type MetricUnit = "share" | "px" | "degrees" | "ratio" | "count";

export interface Metric {
  key: string;
  /** As a row is called. */
  name: string;
  /** As a column is called. */
  short: string;
  unit: MetricUnit;
  /** "near 0" and "near 1" say which value is best where neither end is. */
  best: "higher" | "lower" | "near 0" | "near 1";
  meaning: string;
}

export const metric = (
  key: string,
  name: string,
  short: string,
  unit: MetricUnit,
  best: Metric["best"],
  meaning: string,
): Metric => ({ key, name, short, unit, best, meaning });

export interface MetricGroup {
  title: string;
  /** Which protocol the numbers stand under. */
  protocol: string;
  note: string;
  metrics: readonly Metric[];
}
