import { type RefObject, useMemo } from "react";
import { focusJoin } from "../stages/join_list";

/** Moves the focus between the image and the panel. */
export interface PageFocus {
  enterImage: () => void;
  leaveImage: () => void;
  /** Moves it through what joined the selected candidate's pieces. */
  stepJoin: (direction: 1 | -1) => void;
}

export function usePageFocus(
  regionRef: RefObject<HTMLElement | null>,
  panelRef: RefObject<HTMLElement | null>,
): PageFocus {
  return useMemo(
    () => ({
      enterImage: () => regionRef.current?.focus({ preventScroll: true }),
      leaveImage: () => panelRef.current?.focus(),
      stepJoin: (direction) => focusJoin(panelRef.current, direction),
    }),
    [regionRef, panelRef],
  );
}
