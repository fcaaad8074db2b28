/** What stays selected when an image's candidates are fetched again, after an edit or a run. */

import type { Edit } from "../../api/types";
import type { LabelStore } from "../label_store";

/** Ids of all that is selected. */
export function selectedSegments(store: LabelStore): number[] {
  const { candidates, selection } = store.getState();
  return selection.flatMap((index) => candidates[index]?.id ?? []);
}

/**
 * The segments that take the place of those that were selected.
 *
 * @param selected What was selected last, then what was before; the first of which something is left counts.
 * @param edit The edit that was made, undone or done again in between; the lines that it brought are selected, but of the
 *   parts of a cut only the first: most often they get different verdicts.
 */
export function carriedSelection(
  selected: readonly (readonly number[])[],
  edit: Pick<Edit, "kind" | "added" | "replaced"> | null,
  has: (segmentId: number) => boolean,
): number[] {
  const all = edit === null ? [] : [...edit.added, ...edit.replaced].filter(has);
  const brought = edit?.kind === "cut" ? all.slice(0, 1) : all;
  return [brought, ...selected.map((ids) => ids.filter(has))].find((ids) => ids.length > 0) ?? [];
}
