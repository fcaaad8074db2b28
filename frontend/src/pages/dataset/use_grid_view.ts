import { type RefObject, useCallback, useLayoutEffect, useMemo, useState } from "react";
import { type GridLayout, tilePlace, tilesInView } from "./grid_layout";

interface Measured {
  width: number;
  /** Top of the view relative to the grid's top. */
  top: number;
  height: number;
}

export const SCROLLER = ".frame__content";
/** What sticks to the top of the page covers tiles, and so does the bar at its bottom, by so many px. */
const STICKY = ".image-filters";
const COVERED_BELOW = 72;

/** Measures the grid and the part of it that is in view, and follows both. */
export function useGridView(
  root: RefObject<HTMLElement | null>,
  count: number,
  layoutOf: (width: number) => GridLayout,
) {
  const [measured, setMeasured] = useState<Measured>({ width: 0, top: 0, height: 0 });

  useLayoutEffect(() => {
    const grid = root.current;
    const scroller = grid?.closest<HTMLElement>(SCROLLER);
    if (!grid || !scroller) return;
    let frame = 0;
    const measure = () => {
      frame = 0;
      const box = grid.getBoundingClientRect();
      const view = scroller.getBoundingClientRect();
      const next = { width: grid.clientWidth, top: view.top - box.top, height: view.height };
      setMeasured((old) =>
        old.width === next.width && old.top === next.top && old.height === next.height ? old : next,
      );
    };
    const later = () => {
      frame ||= requestAnimationFrame(measure);
    };
    measure();
    const sizes = new ResizeObserver(later);
    sizes.observe(grid);
    sizes.observe(scroller);
    scroller.addEventListener("scroll", later, { passive: true });
    return () => {
      cancelAnimationFrame(frame);
      sizes.disconnect();
      scroller.removeEventListener("scroll", later);
    };
  }, [root]);

  const layout = useMemo(() => layoutOf(measured.width), [layoutOf, measured.width]);
  const { first, end } =
    measured.width > 0 ? tilesInView(layout, count, measured.top, measured.height) : { first: 0, end: 0 };

  /** Scrolls as little as needed for a tile to be in view. */
  const reveal = useCallback(
    (index: number) => {
      const grid = root.current;
      const scroller = grid?.closest<HTMLElement>(SCROLLER);
      if (!grid || !scroller) return;
      const top = tilePlace(layout, index).top;
      const covered = scroller.querySelector(STICKY)?.clientHeight ?? 0;
      const viewTop = scroller.getBoundingClientRect().top - grid.getBoundingClientRect().top + covered;
      const viewEnd = viewTop + scroller.clientHeight - covered - COVERED_BELOW;
      if (top < viewTop) scroller.scrollTop -= viewTop - top;
      else if (top + layout.tileHeight > viewEnd) scroller.scrollTop += top + layout.tileHeight - viewEnd;
    },
    [root, layout],
  );

  return { layout, first, end, reveal };
}
