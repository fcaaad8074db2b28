import {
  type KeyboardEvent,
  type MouseEvent,
  useCallback,
  useEffect,
  useMemo,
  useRef,
  useState,
} from "react";
import { useNavigate } from "react-router";
import type { ImageSummary } from "../../api/types";
import { commonAspect, type GridSize, gridHeight, gridLayout, tileAfterKey, tilePlace } from "./grid_layout";
import { ImageTile } from "./image_tile";
import { extended, type Selection, toggled } from "./selection";
import { useGridView } from "./use_grid_view";
import "./image_grid.css";

interface ImageGridProps {
  slug: string;
  /** Those loaded so far, from the first on. */
  items: readonly ImageSummary[];
  total: number;
  size: GridSize;
  /** Whether images can be selected. */
  choosable: boolean;
  selection: Selection;
  onSelect: (change: (selection: Selection) => Selection) => void;
  /** Places `[first, end)` in view. */
  onView: (first: number, end: number) => void;
}

/** Thumbnails of any number of images: only those in view are in the page. */
export function ImageGrid(props: ImageGridProps) {
  const { slug, items, total, size, choosable, selection, onSelect, onView } = props;
  const root = useRef<HTMLUListElement>(null);
  const [current, setCurrent] = useState(0);
  const navigate = useNavigate();
  // The first images decide, so that tiles don't change their shape while more are loaded.
  const aspect = useMemo(() => commonAspect(items.slice(0, 50)), [items]);
  const layout = useCallback((width: number) => gridLayout(width, size, aspect), [size, aspect]);
  const view = useGridView(root, total, layout);
  const order = useRef<readonly ImageSummary[]>(items);
  order.current = items;
  const choosing = useRef(false);
  choosing.current = selection.ids.size > 0;

  useEffect(() => onView(view.first, view.end), [onView, view.first, view.end]);

  const select = useCallback(
    (event: { shiftKey: boolean }, id: number) => {
      if (!choosable) return;
      const ids = order.current.map((image) => image.id);
      onSelect((old) => (event.shiftKey ? extended(old, ids, id) : toggled(old, id)));
    },
    [choosable, onSelect],
  );
  const onCheck = useCallback(
    (event: MouseEvent, image: ImageSummary, index: number) => {
      setCurrent(index);
      select(event, image.id);
    },
    [select],
  );
  const onPress = useCallback(
    (event: MouseEvent, image: ImageSummary, index: number) => {
      setCurrent(index);
      // A press by Enter has no detail and always opens; while images are being chosen, the mouse goes on choosing.
      const byMouse = event.detail > 0 && !event.ctrlKey && !event.metaKey;
      const chooses = byMouse && (event.shiftKey || choosing.current);
      if (chooses || image.deleted_at !== null) event.preventDefault();
      if (chooses) select(event, image.id);
    },
    [select],
  );

  const onKeyDown = (event: KeyboardEvent) => {
    if (!(event.target instanceof HTMLElement) || event.target.dataset.index === undefined) return;
    const image = items[current];
    if (event.key === " " && image) {
      event.preventDefault();
      select(event, image.id);
      return;
    }
    if (event.key === "Enter" && image && image.deleted_at === null) {
      event.preventDefault();
      navigate(`/datasets/${slug}/images/${image.id}`);
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = tileAfterKey(event.key, current, view.layout.columns, items.length);
    if (next === null) return;
    event.preventDefault();
    setCurrent(next);
    view.reveal(next);
    const chosen = items[next];
    if (event.shiftKey && chosen) select(event, chosen.id);
  };

  const shown = placesShown(view.first, view.end, current, items.length);
  useFocusFollows(root, current);
  const picture = size === "large" ? 640 : 320;
  return (
    <ul
      ref={root}
      className="image-grid"
      aria-label="Images"
      style={{ height: gridHeight(view.layout, total) }}
      onKeyDown={onKeyDown}
    >
      {shown.map((index) => {
        const image = items[index];
        const { left, top } = tilePlace(view.layout, index);
        const { tileWidth: width, tileHeight: height, mediaHeight } = view.layout;
        return (
          <li
            key={image?.id ?? `place-${index}`}
            aria-setsize={total}
            aria-posinset={index + 1}
            style={{ left, top, width, height, "--media-height": `${mediaHeight}px` } as React.CSSProperties}
          >
            {image ? (
              <ImageTile
                image={image}
                slug={slug}
                index={index}
                size={picture}
                selected={selection.ids.has(image.id)}
                current={index === Math.min(current, items.length - 1)}
                onPress={onPress}
                onCheck={choosable ? onCheck : null}
              />
            ) : (
              <div className="image-tile image-tile--loading skeleton" />
            )}
          </li>
        );
      })}
    </ul>
  );
}

/** The tiles in view, and the current one even when it isn't: what has the focus must stay in the page. */
function placesShown(first: number, end: number, current: number, loaded: number): number[] {
  const places = Array.from({ length: end - first }, (_, offset) => first + offset);
  return current < loaded && (current < first || current >= end) ? [...places, current] : places;
}

/** Moves the focus to the current tile when it was on another one. */
function useFocusFollows(root: React.RefObject<HTMLElement | null>, current: number): void {
  useEffect(() => {
    const focused = document.activeElement;
    if (!(focused instanceof HTMLElement) || !root.current?.contains(focused)) return;
    if (focused.dataset.index === undefined || focused.dataset.index === String(current)) return;
    root.current.querySelector<HTMLElement>(`[data-index="${current}"]`)?.focus({ preventScroll: true });
  }, [root, current]);
}
