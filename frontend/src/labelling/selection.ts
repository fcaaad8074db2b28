/** What becomes of the selection of one image: from its state to what is selected next. */

import { isShown, type LabelState, verdictAt } from "./label_state";
import { nextInSequence } from "./order";

/** The candidate that the panel shows, and all that are selected with it. */
export type Selection = Pick<LabelState, "selected" | "selection">;

export const NOTHING_SELECTED: Selection = { selected: null, selection: [] };

export function selectionOfOne(index: number): Selection {
  return { selected: index, selection: [index] };
}

/** Exactly these; the panel shows the first of them in the order of review. */
export function selectionOf({ sequence }: LabelState, indices: Iterable<number>): Selection {
  const wanted = new Set(indices);
  const selection = sequence.filter((index) => wanted.has(index));
  return { selected: selection[0] ?? null, selection };
}

/** With one candidate more, or one less where it was selected; the panel shows the one that came last. */
export function toggledSelection({ selection }: LabelState, index: number): Selection {
  const left = selection.filter((other) => other !== index);
  const next = left.length < selection.length ? left : [...selection, index];
  return { selected: next.at(-1) ?? null, selection: next };
}

/** The next (or previous) candidate that is shown; null: there is none. */
export function nextShown(state: LabelState, from: number | null, direction: 1 | -1): number | null {
  return nextInSequence(state.sequence, from, direction, (index) => isShown(state, index));
}

/** The next candidate that is shown and waits for a verdict; null: there is none. */
export function nextToJudge(state: LabelState, from: number): number | null {
  const wanted = (index: number) => isUndecided(state, index) && isShown(state, index);
  return nextInSequence(state.sequence, from, 1, wanted);
}

/** The first candidate that waits for a verdict, shown or not; null: there is none. */
export function firstUndecided(state: LabelState): number | null {
  return nextInSequence(state.sequence, null, 1, (index) => isUndecided(state, index));
}

export function isUndecided(state: LabelState, index: number): boolean {
  return verdictAt(state, index) === "undecided";
}
