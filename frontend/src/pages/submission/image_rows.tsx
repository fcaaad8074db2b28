import { type KeyboardEvent, useEffect, useRef, useState } from "react";
import { Link } from "react-router";
import type { ScoredImage } from "../../api/board_types";
import { Ellipsis } from "../../design/ellipsis";
import { type GridLayout, gridHeight, tileAfterKey, tilePlace } from "../dataset/grid_layout";
import { useGridView } from "../dataset/use_grid_view";
import { metricText } from "../metrics";
import { IMAGE_COLUMNS } from "./image_sort";

const ROW = 52;
const NEAR_END = 40;

interface ImageRowsProps {
  submission: number;
  /** Those loaded so far, from the first on. */
  items: readonly ScoredImage[];
  total: number;
  /** Parameters of the viewer's address. */
  query: string;
  /** More rows are wanted. */
  onEnd: () => void;
}

/** Rows of any number of images: only those in view are in the page. */
export function ImageRows({ submission, items, total, query, onEnd }: ImageRowsProps) {
  const root = useRef<HTMLUListElement>(null);
  const [current, setCurrent] = useState(0);
  const view = useGridView(root, total, oneColumn);
  const wanted = view.end + NEAR_END > items.length && items.length < total;
  useEffect(() => {
    if (wanted) onEnd();
  });
  const move = useRef(false);
  useEffect(() => {
    if (!move.current) return;
    move.current = false;
    root.current?.querySelector<HTMLElement>(`[data-index="${current}"]`)?.focus({ preventScroll: true });
  }, [current]);

  const onKeyDown = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = tileAfterKey(event.key, current, 1, items.length);
    if (next === null || event.key === "ArrowLeft" || event.key === "ArrowRight") return;
    event.preventDefault();
    move.current = true;
    setCurrent(next);
    view.reveal(next);
  };

  const shown = Array.from({ length: view.end - view.first }, (_, offset) => view.first + offset);
  if (current < items.length && !shown.includes(current)) shown.push(current);
  return (
    <ul
      ref={root}
      className="scored-images__rows card"
      aria-label="Images"
      style={{ height: gridHeight(view.layout, total) }}
      onKeyDown={onKeyDown}
    >
      {shown.map((index) => {
        const image = items[index];
        return (
          <li
            key={image?.image_id ?? `place-${index}`}
            aria-setsize={total}
            aria-posinset={index + 1}
            style={{ top: tilePlace(view.layout, index).top, height: ROW }}
          >
            {image ? (
              <Link
                className="scored-row"
                data-index={index}
                tabIndex={index === current ? 0 : -1}
                to={`/submissions/${submission}/images/${image.image_id}${query}`}
                aria-label={rowText(image)}
                onFocus={() => setCurrent(index)}
              >
                <img
                  className="scored-row__picture"
                  src={image.thumbnail}
                  alt=""
                  loading="lazy"
                  decoding="async"
                />
                {IMAGE_COLUMNS.map(([column]) =>
                  column === "name" ? (
                    <span key={column} className="scored-row__name">
                      <Ellipsis text={image.name} end={14} />
                    </span>
                  ) : (
                    <span key={column} className={`scored-row__number scored-row__${column}`}>
                      {column === "tp" || column === "fp" || column === "fn"
                        ? image[column]
                        : metricText(column, image[column])}
                    </span>
                  ),
                )}
              </Link>
            ) : (
              <div className="scored-row scored-row--loading skeleton" />
            )}
          </li>
        );
      })}
    </ul>
  );
}

function oneColumn(width: number): GridLayout {
  return { columns: 1, tileWidth: width, mediaHeight: 0, tileHeight: ROW, gap: 0 };
}

function rowText({ name, f1, tp, fp, fn }: ScoredImage): string {
  return `${name}: F1 ${metricText("f1", f1)}, ${tp} found, ${fp} wrong, ${fn} missed`;
}
