/** Steps of a map's colours: round numbers that a legend can name. */

import { ticks } from "./scale";

/** Evenly from zero on, or in round steps of a factor where values lie decades apart. */
export type Spacing = "even" | "decades";

export interface Levels {
  /** Ascending; level 0 lies below the first, the last one from the last on. */
  readonly breaks: readonly number[];
  /** 0 to the number of breaks. */
  readonly of: (value: number) => number;
}

/** Series of round numbers within a decade, the finest first. */
const SERIES = [[1, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]] as const;
/** Colours that there are; see charts/cell_map.css. */
export const COLOURS = 9;

export function levelsOf(values: readonly number[], spacing: Spacing, most = COLOURS): Levels {
  const known = values.filter((value) => Number.isFinite(value) && value > 0);
  const highest = Math.max(0, ...known);
  const breaks = highest === 0 ? [] : spacing === "even" ? even(highest, most) : decades(known, most);
  return { breaks, of: (value) => breaks.filter((limit) => value >= limit).length };
}

/** Which of the colours a level has, so that the first and the last are always used. */
export function colourOf(level: number, levels: Levels): number {
  const last = levels.breaks.length;
  return last === 0 ? 0 : Math.round((level * (COLOURS - 1)) / last);
}

function even(highest: number, most: number): number[] {
  return ticks([0, highest], most - 2).filter((value) => value > 0 && value <= highest);
}

/** The finest series between the lowest and the highest value for which there are colours. */
function decades(values: readonly number[], most: number): number[] {
  const lowest = Math.min(...values);
  const highest = Math.max(...values);
  const found = SERIES.map((factors) => between(lowest, highest, factors));
  const fitting = found.find((series) => series.length < most);
  // Beyond that many decades the lowest ones look alike.
  return fitting ?? (found.at(-1) ?? []).slice(1 - most);
}

function between(lowest: number, highest: number, factors: readonly number[]): number[] {
  const series: number[] = [];
  for (let power = Math.floor(Math.log10(lowest)); power <= Math.log10(highest); power++) {
    for (const factor of factors) {
      const value = Number((factor * 10 ** power).toPrecision(2));
      if (value > lowest && value <= highest) series.push(value);
    }
  }
  return series;
}
