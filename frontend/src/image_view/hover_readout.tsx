import type { ReactNode } from "react";
import type { Point } from "../canvas/geometry";

/** What lies under the pointer, beside it. */
export function HoverReadout({ screen, children }: { screen: Point; children: ReactNode }) {
  return (
    <div
      className="hover-readout"
      aria-hidden="true"
      style={{ transform: `translate(${Math.round(screen.x + 16)}px, ${Math.round(screen.y + 18)}px)` }}
    >
      {children}
    </div>
  );
}
