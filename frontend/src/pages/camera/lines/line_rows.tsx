import { type KeyboardEvent, useEffect, useRef, useState } from "react";
import type { CalibrationLine, CameraDetail } from "../../../api/camera_types";
import { type GridLayout, gridHeight, tileAfterKey, tilePlace } from "../../dataset/grid_layout";
import { useGridView } from "../../dataset/use_grid_view";
import { LineRow } from "./line_row";

const ROW = 58;
const NEAR_END = 60;
/** The bars' full length is the largest residual among so many. */
const MOST_COMPARED = 500;

interface LineRowsProps {
  camera: CameraDetail;
  /** Those loaded so far, from the first on. */
  items: readonly CalibrationLine[];
  total: number;
  /** More rows are wanted. */
  onEnd: () => void;
}

/** Rows of any number of lines: only those in view are in the page. Arrow keys walk, Enter opens a line. */
export function LineRows({ camera, items, total, onEnd }: LineRowsProps) {
  const root = useRef<HTMLUListElement>(null);
  const [current, setCurrent] = useState(0);
  const view = useGridView(root, total, oneColumn);
  const wanted = view.end + NEAR_END > items.length && items.length < total;
  useEffect(() => {
    if (wanted) onEnd();
  });
  const moved = useRef(false);
  useEffect(() => {
    if (!moved.current) return;
    moved.current = false;
    root.current?.querySelector<HTMLElement>(`[data-index="${current}"]`)?.focus({ preventScroll: true });
  }, [current]);

  const onKeyDown = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = tileAfterKey(event.key, current, 1, items.length);
    if (next === null || event.key === "ArrowLeft" || event.key === "ArrowRight") return;
    event.preventDefault();
    moved.current = true;
    setCurrent(next);
    view.reveal(next);
  };

  const worst = Math.max(1e-6, ...items.slice(0, MOST_COMPARED).map(({ rms }) => rms ?? 0));
  const shown = Array.from({ length: view.end - view.first }, (_, offset) => view.first + offset);
  if (current < items.length && !shown.includes(current)) shown.push(current);
  return (
    <>
      <div className="line-row line-row--heads" aria-hidden="true">
        <span />
        <span>Image</span>
        <span className="line-row__residual">Residual, px RMS</span>
        <span className="line-row__number">Most, px</span>
        <span className="line-row__number line-row__optional">Length, px</span>
        <span className="line-row__number line-row__optional">Weight</span>
      </div>
      <ul
        ref={root}
        className="line-rows card"
        aria-label="Lines"
        style={{ height: gridHeight(view.layout, total) }}
        onKeyDown={onKeyDown}
      >
        {shown.map((index) => {
          const line = items[index];
          return (
            <li
              key={line ? line.segment_id : `place-${index}`}
              aria-setsize={total}
              aria-posinset={index + 1}
              style={{ top: tilePlace(view.layout, index).top, height: ROW }}
            >
              {line ? (
                <LineRow
                  camera={camera}
                  line={line}
                  index={index}
                  current={index === current}
                  worst={worst}
                  onFocus={() => setCurrent(index)}
                />
              ) : (
                <div className="line-row line-row--loading skeleton" />
              )}
            </li>
          );
        })}
      </ul>
    </>
  );
}

function oneColumn(width: number): GridLayout {
  return { columns: 1, tileWidth: width, mediaHeight: 0, tileHeight: ROW, gap: 0 };
}
