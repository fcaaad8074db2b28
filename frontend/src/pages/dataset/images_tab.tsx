import { useQuery } from "@tanstack/react-query";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { useSearchParams } from "react-router";
import { getFacets } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { peopleQuery } from "../../api/team_endpoints";
import type { Dataset, Run } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { formatCount, formatQuantity } from "../../design/format";
import { EmptyState, ErrorState } from "../../design/states";
import { failed } from "../datasets/use_dataset_actions";
import { finishedCount } from "../run_text";
import { useHotkeys } from "../use_hotkeys";
import { BulkBar } from "./bulk_bar";
import type { GridSize } from "./grid_layout";
import { ImageFilters } from "./image_filters";
import { ImageGrid } from "./image_grid";
import { EVERYTHING, type ImageView, isFiltered, readView, toFilter, writeView } from "./image_view";
import { all, NOTHING_SELECTED, type Selection } from "./selection";
import { useFollow } from "./use_follow";
import { useGridSize } from "./use_grid_size";
import { SCROLLER } from "./use_grid_view";
import { useImageActions } from "./use_image_actions";
import { useImages } from "./use_images";
import { useScrollPlace } from "./use_scroll_place";
import "./images_tab.css";

const REFRESH_MS = 1_500;

interface ImagesTabProps {
  dataset: Dataset;
  active: Run | null;
  onPrelabel: (ids: number[]) => void;
}

export function ImagesTab({ dataset, active, onPrelabel }: ImagesTabProps) {
  const { slug } = dataset;
  const [parameters, setParameters] = useSearchParams();
  const address = parameters.toString();
  const view = useMemo(() => readView(new URLSearchParams(address)), [address]);
  const filter = useMemo(() => toFilter(view), [view]);
  const facets = useQuery({ queryKey: keys.facets(slug), queryFn: () => getFacets(slug) });
  const images = useImages(slug, filter);
  const { query, items, total, exact, refresh, loadAll } = images;
  const [selection, setSelection] = useState<Selection>(NOTHING_SELECTED);
  const [size, setSize] = useGridSize();
  const actions = useImageActions(slug);
  // All that can be done with chosen images changes them.
  const { maintain: choosable } = useRights();
  const people = useQuery({ ...peopleQuery(slug), enabled: choosable && selection.ids.size > 0 }).data ?? [];
  const tab = useRef<HTMLDivElement>(null);
  const searchField = useRef<HTMLInputElement>(null);
  const scroller = useRef<HTMLElement | null>(null);
  useEffect(() => {
    scroller.current = tab.current?.closest<HTMLElement>(SCROLLER) ?? null;
  }, []);
  useScrollPlace(scroller, query.isSuccess);

  const change = useCallback(
    (changes: Partial<ImageView>) => {
      setSelection(NOTHING_SELECTED);
      // Each letter typed needs no entry of its own in the history.
      setParameters((old) => writeView(old, changes), {
        replace: "search" in changes,
        preventScrollReset: true,
      });
    },
    [setParameters],
  );

  const { fetchNextPage, hasNextPage, isFetchingNextPage } = query;
  const inView = useRef({ first: 0, end: 0 });
  const onView = useCallback(
    (first: number, end: number) => {
      inView.current = { first, end };
      if (end >= items.length && hasNextPage && !isFetchingNextPage) void fetchNextPage();
    },
    [items.length, hasNextPage, isFetchingNextPage, fetchNextPage],
  );
  useRefreshWhile(active, () => refresh(inView.current.first, inView.current.end));

  const selectAll = async () => {
    if (!choosable) return;
    try {
      const everything = hasNextPage ? await loadAll() : items;
      setSelection(all(everything.map((image) => image.id)));
    } catch (error) {
      failed(error);
    }
  };
  useHotkeys({
    "/": () => searchField.current?.focus(),
    escape: () => setSelection(NOTHING_SELECTED),
    delete: () => void removeSelected(),
  });
  useSelectAllKey(selectAll);

  const ids = [...selection.ids];
  const clear = () => setSelection(NOTHING_SELECTED);
  const removeSelected = async () => {
    if (ids.length > 0 && view.status !== "deleted" && (await actions.remove(ids))) clear();
  };

  return (
    <div ref={tab} className={`images-tab${ids.length > 0 ? " images-tab--choosing" : ""}`}>
      <ImageFilters
        slug={slug}
        view={view}
        facets={facets.data}
        size={size}
        countText={countText(view, total, exact, dataset.images, query.isPending)}
        searchField={searchField}
        onChange={change}
        onSize={setSize}
      />
      {query.isError && items.length === 0 ? (
        <ErrorState error={query.error} onRetry={() => query.refetch()} />
      ) : query.isPending ? (
        <GridSkeleton size={size} />
      ) : total === 0 ? (
        <EmptyState
          icon="filter"
          title="No image fits"
          actions={
            isFiltered(view) ? <Button onClick={() => change(EVERYTHING)}>Show all images</Button> : null
          }
        >
          {view.status === "deleted" ? "No deleted image can be restored." : "Nothing matches these filters."}
        </EmptyState>
      ) : (
        <ImageGrid
          slug={slug}
          items={items}
          total={total}
          size={size}
          choosable={choosable}
          selection={selection}
          onSelect={setSelection}
          onView={onView}
        />
      )}
      {query.isFetchNextPageError ? (
        <div className="images-tab__more">
          <Button icon="retry" onClick={() => fetchNextPage()}>
            Load more images
          </Button>
        </div>
      ) : null}
      {ids.length > 0 ? (
        <BulkBar
          count={ids.length}
          deleted={view.status === "deleted"}
          facets={facets.data}
          people={people.map(({ person }) => person)}
          onSet={(changes) => actions.change(ids, changes)}
          onAssign={(person) => actions.assign(ids, person)}
          onPrelabel={() => onPrelabel(ids)}
          onDelete={() => void removeSelected()}
          onRestore={async () => (await actions.restore(ids)) && clear()}
          onClear={clear}
        />
      ) : null}
    </div>
  );
}

/** While a run goes on, what is in view is asked for again each time that images were finished. */
function useRefreshWhile(active: Run | null, refresh: () => Promise<void>): void {
  const follow = () => void refresh().catch(() => undefined);
  useFollow(
    active ? `${active.id} ${finishedCount(active)} ${active.counts.running}` : null,
    REFRESH_MS,
    follow,
  );
  const first = useRef(follow);
  first.current = follow;
  useEffect(() => {
    // What another page changed, by labelling say, is out of date as well.
    const timer = setTimeout(() => first.current());
    return () => clearTimeout(timer);
  }, []);
}

function useSelectAllKey(selectAll: () => Promise<void>): void {
  const latest = useRef(selectAll);
  latest.current = selectAll;
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.key !== "a") return;
      if (
        event.target instanceof Element &&
        event.target.closest("input[type=search], input.input, textarea")
      )
        return;
      event.preventDefault();
      void latest.current();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, []);
}

function GridSkeleton({ size }: { size: GridSize }) {
  const places = Array.from({ length: size === "small" ? 18 : 8 }, (_, place) => place);
  return (
    <div className={`grid-skeleton grid-skeleton--${size}`} role="status" aria-label="Loading images">
      {places.map((place) => (
        <div key={place} className="skeleton" />
      ))}
    </div>
  );
}

function countText(
  view: ImageView,
  total: number,
  exact: boolean,
  everything: number,
  pending: boolean,
): string {
  if (pending) return " ";
  if (view.status === "deleted") return `${formatQuantity(total, "deleted image")}`;
  return isFiltered(view)
    ? `${formatCount(total)}${exact ? "" : "+"} of ${formatQuantity(everything, "image")}`
    : formatQuantity(total, "image");
}
