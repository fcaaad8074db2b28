/** How a candidate was found, in words and bars. */

import type { ScorePart, StageHistory, StageJoin } from "../api/types";
import { formatQuantity, sentence } from "../design/format";

/** "5 pieces, 4 joins (1 flips its bright side). Extended 12.4 px at its start; not trimmed." */
export function describeStages({ pieces, joins, extended, trimmed }: StageHistory): string {
  const flips = joins.filter((join) => join.flipped).length;
  const sides = flips === 1 ? "1 flips its bright side" : `${flips} flip their bright side`;
  const joined = joins.length === 0 ? "never broken" : formatQuantity(joins.length, "join");
  const beginning = `${formatQuantity(pieces.length, "piece")}, ${joined}${flips === 0 ? "" : ` (${sides})`}.`;
  return `${beginning} ${sentence(`${describeEnds("extended", extended)}; ${describeEnds("trimmed", trimmed)}`)}`;
}

/** "extended 12.4 px at its start, 3.0 px at its end", "not extended". */
function describeEnds(what: string, [start, end]: readonly [number, number]): string {
  const parts = [
    [start, "at its start"],
    [end, "at its end"],
  ] as const;
  const said = parts.flatMap(([length, where]) => (length < LEAST_SAID ? [] : [`${px(length)} ${where}`]));
  return said.length === 0 ? `not ${what}` : `${what} ${said.join(", ")}`;
}

/** What nobody sees isn't said (px). */
const LEAST_SAID = 0.5;

/** In which round of merging a gap was closed, and so what was asked of it. */
export const ROUNDS: Readonly<
  Record<StageJoin["round"], { readonly short: string; readonly whole: string }>
> = {
  following: {
    short: "along one edge",
    whole: "Round 1 of 3: both sides go on as they were, the same one bright",
  },
  flipping: {
    short: "either side bright",
    whole: "Round 2 of 3: the bright side may change, as between windows of a facade",
  },
  "after extension": {
    short: "after extension",
    whole: "Round 3 of 3: once the ends had been followed as far as the edge goes on",
  },
};

export function describeJoin({ round, flipped }: StageJoin): string {
  return flipped ? "bright side flips" : ROUNDS[round].short;
}

export interface ScoreBar {
  readonly name: string;
  /** What was measured, with its unit. */
  readonly measured: string;
  /** What it adds to the evidence, compared with the image's typical candidate. */
  readonly effect: number;
  /** The effect as a share of the strongest one, -1 to 1. */
  readonly share: number;
}

/** Effects smaller than this fill no bar: the bars of a typical candidate are short. */
const LEAST_FULL_BAR = 1;

export function scoreBars(parts: readonly ScorePart[]): ScoreBar[] {
  const effects = parts.map(({ weight, value, typical }) => weight * (value - typical));
  const strongest = Math.max(LEAST_FULL_BAR, ...effects.map(Math.abs));
  return parts.map((part, i) => {
    const effect = effects[i] ?? 0;
    return {
      name: part.name.charAt(0).toUpperCase() + part.name.slice(1),
      measured: measuredText(part),
      effect,
      share: effect / strongest,
    };
  });
}

/** The score that a candidate with the image's typical features has. */
export function typicalScore({ score_parts, intercept }: StageHistory): number {
  const evidence = score_parts.reduce((sum, { weight, typical }) => sum + weight * typical, intercept);
  return 1 / (1 + Math.exp(-evidence));
}

/** "+0.8", "−0.3", "0": with a true minus sign. */
export function signed(value: number): string {
  const text = Math.abs(value).toFixed(1);
  return text === "0.0" ? "0" : `${value > 0 ? "+" : "−"}${text}`;
}

export function px(length: number): string {
  return `${length.toFixed(1)} px`;
}

function measuredText({ measured, unit, value }: ScorePart): string {
  if (measured === null) return value.toFixed(2);
  if (unit === "share") return `${Math.round(100 * measured)} %`;
  if (unit === "px") return `${measured.toFixed(measured < 1 ? 2 : measured < 100 ? 1 : 0)} px`;
  return unit === "grey levels" ? measured.toFixed(0) : `${measured.toFixed(2)} ${unit}`;
}
