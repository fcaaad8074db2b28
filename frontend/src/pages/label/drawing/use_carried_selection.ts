import { useLayoutEffect, useRef } from "react";
import type { Edit } from "../../../api/types";
import { carriedSelection, selectedSegments } from "../../../labelling/drawing/carried_selection";
import type { LabelStore } from "../../../labelling/label_store";

/** The edit whose effect the candidates that come next show. */
export interface LatestEdit {
  edit: Edit | null;
}

/**
 * Keeps selection and view when the same image's candidates are fetched again.
 *
 * @returns Stores that have their selection by now, be it none.
 */
export function useCarriedSelection(
  imageId: number,
  store: LabelStore | null,
  latest: LatestEdit,
): WeakSet<LabelStore> {
  const before = useRef<{ imageId: number; store: LabelStore } | null>(null);
  const carried = useRef(new WeakSet<LabelStore>());
  /** What was selected when an edit was made, which taking it back selects again. */
  const former = useRef(new Map<string, readonly number[]>());
  useLayoutEffect(() => {
    if (store === null) return;
    const known = before.current;
    before.current = { imageId, store };
    if (known === null || known.imageId !== imageId || known.store === store) return;
    const { edit } = latest;
    latest.edit = null;
    const has = (id: number) => store.indexOfSegment(id) !== null;
    const selected = selectedSegments(known.store);
    const back = edit === null ? [] : (former.current.get(edit.client_id) ?? []);
    if (edit !== null && back.length === 0) former.current.set(edit.client_id, selected);
    const ids = carriedSelection([selected, back], edit, has);
    store.selectAll(ids.flatMap((id) => store.indexOfSegment(id) ?? []));
    if (edit !== null) carried.current.add(store);
  }, [imageId, store, latest]);
  return carried.current;
}
