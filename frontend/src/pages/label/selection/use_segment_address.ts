import { useEffect } from "react";
import type { LabelStore } from "../../../labelling/label_store";

const PARAMETER = "segment";
/** Browsers refuse more than about three changes of the address per second. */
const PAUSE = 500;

/** The id of the candidate that the address names. */
export function segmentInAddress(): number | null {
  const value = new URLSearchParams(window.location.search).get(PARAMETER);
  return value === null || !/^\d+$/.test(value) ? null : Number(value);
}

/** The page's address with a candidate in it, or without. */
export function addressOf(segmentId: number | null): string {
  const address = new URL(window.location.href);
  if (segmentId === null) address.searchParams.delete(PARAMETER);
  else address.searchParams.set(PARAMETER, String(segmentId));
  return address.href;
}

/**
 * Starts with the candidate that the address names, else with the first undecided one.
 *
 * @param settled Stores whose selection is as it should be, be it none.
 */
export function useFirstSelection(store: LabelStore | null, settled: WeakSet<LabelStore>): void {
  useEffect(() => {
    if (store === null || settled.has(store) || store.getState().selected !== null) return;
    const wanted = segmentInAddress();
    const index = wanted === null ? null : store.indexOfSegment(wanted);
    if (index !== null) store.select(index, { follow: true });
    else store.selectFirstUndecided();
  }, [store, settled]);
}

/** Keeps the selected candidate in the address, so that it can be shared; the history gets no entries of it. */
export function useSegmentAddress(store: LabelStore | null): void {
  useEffect(() => {
    if (store === null) return;
    let timer: ReturnType<typeof setTimeout> | null = null;
    const write = () => {
      timer = null;
      const { selected, candidates } = store.getState();
      const id = selected === null ? null : (candidates[selected]?.id ?? null);
      if (id !== segmentInAddress()) window.history.replaceState(window.history.state, "", addressOf(id));
    };
    const stop = store.subscribe(() => {
      timer ??= setTimeout(write, PAUSE);
    });
    return () => {
      stop();
      if (timer !== null) clearTimeout(timer);
    };
  }, [store]);
}
