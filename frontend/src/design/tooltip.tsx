import type { ReactNode } from "react";
import { Keys } from "./kbd";

interface TooltipProps {
  text: string;
  keys?: string[] | undefined;
  side?: "down" | "up" | "end" | "after" | undefined;
  children: ReactNode;
}

/** Shows on hover and on keyboard focus. The bubble repeats the control's own name, so it is hidden from readers. */
export function Tooltip({ text, keys, side = "down", children }: TooltipProps) {
  return (
    <span className={`tooltip tooltip--${side}`}>
      {children}
      <span className="tooltip__bubble" aria-hidden="true">
        {text}
        {keys ? <Keys keys={keys} /> : null}
      </span>
    </span>
  );
}
