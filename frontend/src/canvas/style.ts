/**
 * How lines look on an image.
 *
 * The colours of candidates are after the palette of Okabe and Ito ("Color Universal Design", 2008), brightened, and
 * told apart without colour too: by width, dashes and markers. A dark casing under each line keeps it readable on
 * bright pixels, the bright core on dark ones.
 */

import type { Verdict } from "../api/types";

export interface LineStyle {
  readonly colour: string;
  /** Screen px. */
  readonly width: number;
  /** Lengths of dashes and gaps in screen px; empty for a solid line. */
  readonly dash: readonly number[];
  readonly opacity: number;
}

export const LINE_STYLES: Readonly<Record<Verdict, LineStyle>> = {
  undecided: { colour: "#5cc3ff", width: 1.6, dash: [], opacity: 1 },
  keep: { colour: "#2ee6a0", width: 3, dash: [], opacity: 1 },
  reject: { colour: "#ff7a4d", width: 1.4, dash: [2, 4], opacity: 0.85 },
  ambiguous: { colour: "#ffe14d", width: 2.2, dash: [9, 5], opacity: 1 },
};

/** Undecided candidates that the straightness test fails: thinner, long dashes. */
export const BENT_STYLE: LineStyle = { colour: "#c9b8ff", width: 1.4, dash: [14, 4, 2, 4], opacity: 0.95 };

export const CASING = { colour: "rgba(6, 10, 16, 0.62)", extra: 2.2 } as const;
export const SELECTION = { halo: "#ffffff", casing: "rgba(6, 10, 16, 0.85)", width: 3.2 } as const;

/** What belongs to the selected line, such as the label that a prediction comes closest to. */
export const COMPANION = { colour: "#ffffff", width: 1.6, dash: [1.5, 3.5] } as const;

/**
 * How a candidate was found. The pieces' colours take turns and differ in hue and lightness for everybody; ticks at
 * their ends, dashes over gaps and dots along what was added say the same without colour.
 */
export const STAGES = {
  rim: { colour: "#ffffff", width: 10.6 },
  bed: { colour: "#0a0f17", width: 8.6 },
  pieces: { colours: ["#ffbf40", "#5fb8ff"], width: 4 },
  gap: { colour: "#ffffff", width: 2, dash: [4, 4] },
  added: { colour: "#ffffff", width: 3.4, dash: [0.01, 6.5] },
  tick: { colour: "#ffffff", width: 1.6, reach: 7 },
  mark: { colour: "#ffffff", width: 2.4, radius: 12 },
} as const;

/** Drawing order: what matters most lies on top. */
export const STYLE_ORDER = ["reject", "bent", "undecided", "ambiguous", "keep"] as const;
export type StyleName = (typeof STYLE_ORDER)[number];

export function styleName(verdict: Verdict, bent: boolean): StyleName {
  return verdict === "undecided" && bent ? "bent" : verdict;
}

export function lineStyle(name: StyleName): LineStyle {
  return name === "bent" ? BENT_STYLE : LINE_STYLES[name];
}

/** The styles of candidates in their drawing order. */
export const CANDIDATE_STYLES: readonly LineStyle[] = STYLE_ORDER.map(lineStyle);
