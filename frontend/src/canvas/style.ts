/**
 * How lines look on an image.
 *
 * Candidates are told apart by colour, and without it by width, dashes and markers. A dark casing under each line keeps
 * it readable on bright pixels, the bright core on dark ones.
 */

import type { Verdict } from "../api/types";
import { COLOURS, type ColourName, type Palette } from "./palette";

export interface LineStyle {
  readonly colour: string;
  /** Screen px. */
  readonly width: number;
  /** Lengths of dashes and gaps in screen px; empty for a solid line. */
  readonly dash: readonly number[];
  readonly opacity: number;
  /** What lies under the line in place of the usual dark casing, the lowest first; without gaps. */
  readonly casings?: readonly Casing[];
}

export interface Casing {
  readonly colour: string;
  /** Beyond the line's width, both sides together (screen px). */
  readonly extra: number;
}

export const CASING: Casing = { colour: "rgba(6, 10, 16, 0.62)", extra: 2.2 };
/** Of lines that are selected with others, or that a tool touches: bright with a dark rim, as the selection's halo. */
export const MARKED_CASINGS: readonly Casing[] = [
  { colour: "rgba(6, 10, 16, 0.85)", extra: 5.8 },
  { colour: "#ffffff", extra: 3.8 },
];
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

export const BRUSH = { opacity: 0.38, rim: 1.8, casing: "rgba(6, 10, 16, 0.75)" } as const;
export const LASSO = {
  colour: "#ffffff",
  casing: "rgba(6, 10, 16, 0.75)",
  fill: "rgba(255, 255, 255, 0.1)",
  width: 1.6,
  dash: [6, 4],
} as const;

/** A line that is being traced by hand; dashes stand for one that no edge was found for. */
export const TRACE = {
  colour: "#ffd84d",
  casing: "rgba(6, 10, 16, 0.85)",
  width: 2.6,
  missing: [7, 6],
  point: 4.5,
} as const;

/** Drawing order: what matters most lies on top. */
export const STYLE_ORDER = [
  "reject",
  "suggestedReject",
  "bent",
  "undecided",
  "ambiguous",
  "suggestedKeep",
  "keep",
  "drawn",
] as const;
export type StyleName = (typeof STYLE_ORDER)[number];

/** @param suggested What a model suggests for an undecided candidate, where that is shown. */
export function styleName(
  verdict: Verdict,
  bent: boolean,
  suggested: "keep" | "reject" | null = null,
): StyleName {
  if (verdict !== "undecided") return verdict;
  if (suggested !== null) return suggested === "keep" ? "suggestedKeep" : "suggestedReject";
  return bent ? "bent" : verdict;
}

interface Form extends Omit<LineStyle, "colour"> {
  readonly colour: ColourName;
}

const FORMS: Readonly<Record<StyleName, Form>> = {
  undecided: { colour: "undecided", width: 1.6, dash: [], opacity: 1 },
  keep: { colour: "keep", width: 3, dash: [], opacity: 1 },
  reject: { colour: "reject", width: 1.4, dash: [2, 4], opacity: 0.85 },
  ambiguous: { colour: "ambiguous", width: 2.2, dash: [9, 5], opacity: 1 },
  // Undecided candidates that the straightness test fails: thinner, long dashes.
  bent: { colour: "bent", width: 1.4, dash: [14, 4, 2, 4], opacity: 0.95 },
  // Kept lines of a person's hand: whole like others, with short breaks.
  drawn: { colour: "keep", width: 3, dash: [16, 3], opacity: 1 },
  // Undecided candidates with a suggestion: its colour, but broken where a verdict is whole, and whole where it isn't.
  suggestedKeep: { colour: "keep", width: 2.2, dash: [5, 3], opacity: 1 },
  suggestedReject: { colour: "reject", width: 1.2, dash: [12, 3], opacity: 0.95 },
};

const STYLES: Readonly<Record<Palette, ReadonlyMap<StyleName, LineStyle>>> = {
  standard: stylesIn("standard"),
  safe: stylesIn("safe"),
};

export function lineStyle(name: StyleName, palette: Palette = "standard"): LineStyle {
  return STYLES[palette].get(name) as LineStyle;
}

function stylesIn(palette: Palette): Map<StyleName, LineStyle> {
  return new Map(
    STYLE_ORDER.map((name) => [name, { ...FORMS[name], colour: COLOURS[palette][FORMS[name].colour] }]),
  );
}
