import { type RefObject, useCallback, useEffect, useState } from "react";
import type { Point } from "../../../canvas/geometry";
import type { CanvasView } from "../../../canvas/view";
import { toImage } from "../../../canvas/viewport";

/** Where above the image the pointer was last (image px); null where it never was. */
export type PointerPlaces = () => Point | null;

/** Follows the pointer; its place is kept on the screen, so that it stays right when the view moves. */
export function usePointerPlaces(
  regionRef: RefObject<HTMLElement | null>,
  viewRef: RefObject<CanvasView | null>,
): PointerPlaces {
  const [last] = useState(() => ({ place: null as Point | null }));
  useEffect(() => {
    const region = regionRef.current;
    if (region === null) return;
    const note = (event: PointerEvent) => {
      const box = region.getBoundingClientRect();
      last.place = { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    region.addEventListener("pointermove", note);
    region.addEventListener("pointerdown", note);
    return () => {
      region.removeEventListener("pointermove", note);
      region.removeEventListener("pointerdown", note);
    };
  }, [regionRef, last]);
  return useCallback(() => {
    const view = viewRef.current;
    return view === null || last.place === null ? null : toImage(view.current, last.place.x, last.place.y);
  }, [viewRef, last]);
}
