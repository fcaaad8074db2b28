import type { KeyboardEvent, PointerEvent, RefObject } from "react";
import { edgeAfterKey, edgeText } from "./edge";

interface EdgeSliderProps {
  /** Share of the image's place on the left of the edge, 0 to 1. */
  share: number;
  /** What it is moved over. */
  region: RefObject<HTMLElement | null>;
  onMove: (share: number) => void;
}

/** The edge between before and after: dragged by mouse or finger, moved by arrow keys. */
export function EdgeSlider({ share, region, onMove }: EdgeSliderProps) {
  const drag = (event: PointerEvent) => {
    const box = region.current?.getBoundingClientRect();
    if (!box || box.width === 0) return;
    onMove(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = edgeAfterKey(event.key, share, event.shiftKey);
    if (next === null) return;
    event.preventDefault();
    onMove(next);
  };
  return (
    <div
      className="edge-slider"
      role="slider"
      aria-label="Edge between before and after"
      aria-orientation="horizontal"
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={Math.round(100 * share)}
      aria-valuetext={edgeText(share)}
      tabIndex={0}
      style={{ left: `${100 * share}%` }}
      onKeyDown={onKeyDown}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
      }}
      onPointerMove={(event) => {
        if (event.currentTarget.hasPointerCapture(event.pointerId)) drag(event);
      }}
      onDoubleClick={() => onMove(0.5)}
    >
      <span className="edge-slider__line" />
      <span className="edge-slider__grip" aria-hidden="true">
        <svg width={18} height={12} viewBox="0 0 18 12" focusable="false" aria-hidden="true">
          <path d="M6 1 1 6l5 5M12 1l5 5-5 5" />
        </svg>
      </span>
    </div>
  );
}
