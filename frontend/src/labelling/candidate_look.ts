/** How candidates are drawn: by verdict, and by what is selected, what a tool touches and what is dimmed. */

import type { LineLook } from "../canvas/layers/line_layer";
import type { Palette } from "../canvas/palette";
import {
  type LineStyle,
  lineStyle,
  MARKED_CASINGS,
  STYLE_ORDER,
  type StyleName,
  styleName,
} from "../canvas/style";
import { isBent, isShown, type LabelState, verdictAt } from "./label_state";
import { suggestedAt } from "./suggestions/suggestions";
import { changedBetween, type Touched } from "./tools/preview";

type Stand = "plain" | "dimmed" | "marked";

/** What is dimmed can still be made out, but nothing of it draws the eye. */
const DIMMED = 0.22;

/** Every style that a candidate may have, marked ones above all others. */
type StyleTable = Readonly<Record<Stand, Readonly<Record<StyleName, LineStyle>>>>;

const TABLES: Readonly<Record<Palette, StyleTable>> = {
  standard: tablesIn("standard"),
  safe: tablesIn("safe"),
};

export function candidateLook(state: LabelState, touched: Touched, palette: Palette): LineLook {
  const table = TABLES[palette];
  const several = state.selection.length > 1;
  const selection = new Set(state.selection);
  const { focus } = state.shown;
  return {
    styles: [table.dimmed, table.plain, table.marked].flatMap((styles) =>
      STYLE_ORDER.map((name) => styles[name]),
    ),
    style: (index) => {
      const wanted = touched.get(index) ?? null;
      const suggested = wanted === null ? suggestedAt(state.suggesting, index) : null;
      const verdict = wanted ?? verdictAt(state, index);
      const drawn = verdict === "keep" && state.candidates[index]?.origin === "manual";
      const name = drawn ? "drawn" : styleName(verdict, isBent(state, index), suggested);
      const marked = touched.has(index) || (several && selection.has(index));
      if (marked) return table.marked[name];
      return table[focus === "dim" && selection.size > 0 && !selection.has(index) ? "dimmed" : "plain"][name];
    },
    visible: (index) => {
      if (selection.has(index) || touched.has(index)) return true;
      return isShown(state, index) && !(focus === "solo" && selection.size > 0);
    },
  };
}

/** The candidates that look different now; null where any may. */
export function changedLooks(
  before: { readonly state: LabelState; readonly touched: Touched },
  after: { readonly state: LabelState; readonly touched: Touched },
): number[] | null {
  const { state } = after;
  if (state.shown !== before.state.shown || state.suggesting !== before.state.suggesting) return null;
  // With the first selected candidate all others become faint, with the last one they come back.
  const began = (before.state.selection.length === 0) !== (state.selection.length === 0);
  if (began && state.shown.focus !== "all") return null;
  const changed = new Set(changedBetween(before.touched, after.touched));
  if (state.verdicts !== before.state.verdicts) {
    for (const index of state.sequence) {
      if (state.verdicts[index] !== before.state.verdicts[index]) changed.add(index);
    }
  }
  if (state.selection !== before.state.selection) {
    for (const index of [...before.state.selection, ...state.selection]) changed.add(index);
  }
  return [...changed];
}

function tablesIn(palette: Palette): StyleTable {
  const table = (change: (style: LineStyle) => LineStyle) => {
    const entries = STYLE_ORDER.map((name) => [name, change(lineStyle(name, palette))] as const);
    return Object.fromEntries(entries) as Record<StyleName, LineStyle>;
  };
  return {
    dimmed: table((style) => ({ ...style, opacity: style.opacity * DIMMED })),
    plain: table((style) => style),
    // On the bright casing a thin line would be hard to see.
    marked: table((style) => ({ ...style, width: style.width + 0.8, opacity: 1, casings: MARKED_CASINGS })),
  };
}
