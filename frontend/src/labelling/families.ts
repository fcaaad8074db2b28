/** Candidates along one structure, such as both sides of a pole or a row of windows, that are judged together. */

import { isShown, type LabelState } from "./label_state";

/** Stands for a candidate that is in no family. */
const ALONE = -1;

/**
 * The selected candidates with all of their families that is shown, by index in the order of review.
 *
 * As long as nobody has told the families, that is the selection alone.
 */
export function familyOfSelection(state: LabelState): number[] {
  const chosen = new Set(state.selection);
  const wanted = new Set(state.selection.map((index) => familyAt(state, index)));
  wanted.delete(ALONE);
  return state.sequence.filter(
    (index) => chosen.has(index) || (wanted.has(familyAt(state, index)) && isShown(state, index)),
  );
}

function familyAt({ suggesting }: LabelState, index: number): number {
  return suggesting.of[index]?.family ?? ALONE;
}
