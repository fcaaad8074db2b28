/** Agreement in numbers and in words. */

import type { Kappa } from "../../../api/team_endpoints";

/** "0.82"; a dash where there is nothing to compare, or no chance to agree by. */
export function kappaText({ value }: Pick<Kappa, "value">): string {
  return value === null ? "–" : value.toFixed(2);
}

/** "0.71 to 0.90"; empty where there is no interval. */
export function intervalText({ low, high }: Pick<Kappa, "low" | "high">): string {
  return low === null || high === null ? "" : `${low.toFixed(2)} to ${high.toFixed(2)}`;
}

const WORDS: readonly [number, string][] = [
  [0.81, "almost perfect"],
  [0.61, "substantial"],
  [0.41, "moderate"],
  [0.21, "fair"],
  [0, "slight"],
];

/** The words of Landis and Koch (1977), by which kappas are commonly told. */
export function kappaWord({ value }: Pick<Kappa, "value">): string {
  if (value === null) return "not defined";
  return WORDS.find(([least]) => value >= least)?.[1] ?? "worse than chance";
}
