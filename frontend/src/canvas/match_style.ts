/**
 * How the lines of a scored image look.
 *
 * By default in the colours of the ClearLines paper (green, red, orange) as on the overlay pictures; told apart
 * without colour too: true positives are solid, false positives dashed, misses dotted. The other palette is after
 * Okabe and Ito ("Color Universal Design", 2008): its hues stay apart for every kind of colour vision.
 */

import type { Palette as VerdictPalette } from "./palette";
import { COMPANION, type LineStyle } from "./style";

export type MatchStyleName = "tp" | "fp" | "fn" | "ignored" | "found";

/** From the lowest layer to the highest. */
const DRAWING_ORDER: readonly MatchStyleName[] = ["ignored", "tp", "found", "fp", "fn"];

export const PALETTES = ["paper", "safe"] as const;
export type Palette = (typeof PALETTES)[number];

/** The palette that goes with the one chosen for verdicts. */
export function matchPalette(verdicts: VerdictPalette): Palette {
  return verdicts === "safe" ? "safe" : "paper";
}

const COLOURS: Readonly<Record<Palette, Readonly<Record<"tp" | "fp" | "fn", string>>>> = {
  paper: { tp: "#3cd75a", fp: "#ff4b55", fn: "#ffaa00" },
  safe: { tp: "#5cc3ff", fp: "#ff7a4d", fn: "#ffe14d" },
};

/** How much of its opacity a line keeps that both submissions have. */
const FADED = 0.28;

export interface MatchStyles {
  readonly plain: Readonly<Record<MatchStyleName, LineStyle>>;
  /** For what both submissions have in common, where the differences are looked at. */
  readonly faded: Readonly<Record<MatchStyleName, LineStyle>>;
  /** All of them in drawing order. */
  readonly all: readonly LineStyle[];
}

function makeStyles(palette: Palette): MatchStyles {
  const { tp, fp, fn } = COLOURS[palette];
  const plain: Record<MatchStyleName, LineStyle> = {
    tp: { colour: tp, width: 2.2, dash: [], opacity: 1 },
    fp: { colour: fp, width: 2.2, dash: [9, 5], opacity: 1 },
    // Square dots: browsers take several times as long for round ones.
    fn: { colour: fn, width: 3.2, dash: [3.2, 4.6], opacity: 1 },
    ignored: { colour: "#bebebe", width: 1.4, dash: [14, 4, 2, 4], opacity: 0.85 },
    found: { colour: COMPANION.colour, width: COMPANION.width, dash: COMPANION.dash, opacity: 1 },
  };
  const fade = (name: MatchStyleName): LineStyle => ({ ...plain[name], opacity: FADED });
  const faded: Record<MatchStyleName, LineStyle> = {
    tp: fade("tp"),
    fp: fade("fp"),
    fn: fade("fn"),
    ignored: fade("ignored"),
    found: fade("found"),
  };
  return {
    plain,
    faded,
    all: [...DRAWING_ORDER.map((name) => faded[name]), ...DRAWING_ORDER.map((name) => plain[name])],
  };
}

export const MATCH_STYLES: Readonly<Record<Palette, MatchStyles>> = {
  paper: makeStyles("paper"),
  safe: makeStyles("safe"),
};
