import { useEffect, useRef, useState } from "react";
import { useSearchParams } from "react-router";
import type { Submission } from "../../api/board_types";
import { Button } from "../../design/button";
import { formatCount } from "../../design/format";
import { Icon } from "../../design/icons";
import { EmptyState, ErrorState } from "../../design/states";
import { useHotkeys } from "../use_hotkeys";
import { ImageRows } from "./image_rows";
import { IMAGE_COLUMNS, type ImageColumn, nextImageSort, readImageSort, WORST_FIRST } from "./image_sort";
import { useScoredImages } from "./use_scored_images";
import "./scored_images.css";

const TYPING_MS = 250;

/** The images of a submission, sorted by any of their numbers. */
export function ImagesTab({ submission }: { submission: Submission }) {
  const [parameters, setParameters] = useSearchParams();
  const sort = readImageSort(parameters.get("sort"));
  const search = parameters.get("search") ?? "";
  const { query, items, total } = useScoredImages(submission.id, sort, search);
  const set = (name: string, value: string | null) => {
    const next = new URLSearchParams(parameters);
    if (value === null || value === "") next.delete(name);
    else next.set(name, value);
    setParameters(next, { replace: true, preventScrollReset: true });
  };
  if (query.isError) return <ErrorState error={query.error} onRetry={() => query.refetch()} />;
  return (
    <section className="scored-images" aria-label="Images">
      <div className="scored-images__tools">
        <Search value={search} onSearch={(text) => set("search", text)} />
        <span className="muted numeric" role="status">
          {search === ""
            ? `${formatCount(total)} images`
            : `${formatCount(total)} of ${formatCount(submission.images)} images`}
        </span>
      </div>
      <Heads sort={sort} onSort={(next) => set("sort", next === WORST_FIRST ? null : next)} />
      {query.data && total === 0 ? (
        <EmptyState
          icon="search"
          title="No image of that name"
          actions={<Button onClick={() => set("search", null)}>Show all</Button>}
        />
      ) : (
        <ImageRows
          key={`${sort} ${search}`}
          submission={submission.id}
          items={items}
          total={total}
          query={imageQuery(sort, search, parameters.get("with"))}
          onEnd={() => {
            if (query.hasNextPage && !query.isFetchingNextPage) void query.fetchNextPage();
          }}
        />
      )}
    </section>
  );
}

/** What the viewer's address keeps of this page: its list, and with whom to compare. */
function imageQuery(sort: string, search: string, other: string | null): string {
  const parameters = new URLSearchParams({ sort });
  if (search !== "") parameters.set("search", search);
  if (other) parameters.set("with", other);
  return `?${parameters}`;
}

function Heads({ sort, onSort }: { sort: string; onSort: (sort: string) => void }) {
  return (
    <div className="scored-row scored-images__heads">
      <span />
      {IMAGE_COLUMNS.map(([column, text]) => (
        <Head key={column} column={column} text={text} sort={sort} onSort={onSort} />
      ))}
    </div>
  );
}

interface HeadProps {
  column: ImageColumn;
  text: string;
  sort: string;
  onSort: (sort: string) => void;
}

function Head({ column, text, sort, onSort }: HeadProps) {
  const current = sort.replace(/^-/, "") === column;
  const descending = sort.startsWith("-");
  const state = current ? `, sorted ${descending ? "largest first" : "smallest first"}` : "";
  return (
    <button
      type="button"
      className={`sort-head scored-row__${column === "name" ? "name" : "number"}`}
      aria-pressed={current}
      aria-label={`Sort by ${text}${state}`}
      onClick={() => onSort(nextImageSort(sort, column))}
    >
      {text}
      <Icon
        name={current && descending ? "down" : "up"}
        size={11}
        className={current ? "sort-head__arrow" : "sort-head__arrow sort-head__arrow--idle"}
      />
    </button>
  );
}

function Search({ value, onSearch }: { value: string; onSearch: (text: string) => void }) {
  const [text, setText] = useState(value);
  const field = useRef<HTMLInputElement>(null);
  const latest = useRef(onSearch);
  latest.current = onSearch;
  useHotkeys({ "/": () => field.current?.focus() });
  useEffect(() => {
    if (text === value) return;
    const timer = setTimeout(() => latest.current(text), TYPING_MS);
    return () => clearTimeout(timer);
  }, [text, value]);
  return (
    <input
      ref={field}
      className="input scored-images__search"
      type="search"
      placeholder="Search names  ( / )"
      aria-label="Search images"
      value={text}
      onChange={(event) => setText(event.target.value)}
      onKeyDown={(event) => {
        if (event.key === "Escape") setText("");
      }}
    />
  );
}
