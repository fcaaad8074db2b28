/**
 * The colours of candidates on an image.
 *
 * The standard ones are after the palette of Okabe and Ito ("Color Universal Design", 2008), brightened; with width and
 * dashes they are told apart without colour too. The safe ones stay apart in colour alone for every kind of colour
 * vision: blue, red and yellow of rising lightness as in the high-contrast scheme of Tol ("Colour Schemes", 2021), and
 * greys for what is undecided.
 */

export const PALETTES = ["standard", "safe"] as const;
export type Palette = (typeof PALETTES)[number];

export type ColourName = "undecided" | "keep" | "reject" | "ambiguous" | "bent";

export const COLOURS: Readonly<Record<Palette, Readonly<Record<ColourName, string>>>> = {
  standard: {
    undecided: "#5cc3ff",
    keep: "#2ee6a0",
    reject: "#ff7a4d",
    ambiguous: "#ffe14d",
    bent: "#c9b8ff",
  },
  safe: {
    undecided: "#eef1f6",
    keep: "#2f8fff",
    reject: "#e8503a",
    ambiguous: "#ffcf33",
    bent: "#a7a7b4",
  },
};
