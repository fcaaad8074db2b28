import type { CanvasView } from "../canvas/view";
import type { ViewActions } from "./commands";

/** @param view The view that is there when a key is pressed. */
export function viewActions(view: () => CanvasView | null): ViewActions {
  return {
    fit: () => view()?.fit(),
    zoom: (direction) => view()?.zoomStep(direction),
    pan: (dx, dy) => view()?.panStep(dx, dy),
  };
}
