import { type RefObject, useEffect, useState } from "react";
import type { Facets } from "../../api/types";
import { Button } from "../../design/button";
import { formatCount } from "../../design/format";
import { Icon } from "../../design/icons";
import { Segmented } from "../../design/segmented";
import type { GridSize } from "./grid_layout";
import { EVERYTHING, type ImageView, isFiltered, PRELABELS, SORTS, STATUSES } from "./image_view";
import { MoreFilters } from "./more_filters";

const TYPING_MS = 250;

const STATUS_WORDS = { open: "Open", done: "Done", discarded: "Discarded", deleted: "Deleted" } as const;
const PRELABEL_WORDS = {
  none: "Not pre-labelled",
  queued: "Queued",
  running: "Running",
  done: "Pre-labelled",
  failed: "Failed",
  cancelled: "Cancelled",
} as const;
const SORT_WORDS = {
  name: "Name A-Z",
  "-name": "Name Z-A",
  "-created": "Newest first",
  created: "Oldest first",
  "-candidates": "Most candidates",
  candidates: "Fewest candidates",
} as const;

interface ImageFiltersProps {
  slug: string;
  view: ImageView;
  facets: Facets | undefined;
  size: GridSize;
  /** "12 of 15 images" */
  countText: string;
  searchField: RefObject<HTMLInputElement | null>;
  onChange: (changes: Partial<ImageView>) => void;
  onSize: (size: GridSize) => void;
}

export function ImageFilters(props: ImageFiltersProps) {
  const { slug, view, facets, size, countText, searchField, onChange, onSize } = props;
  const sources = facets?.sources ?? [];
  const sequences = facets?.sequences ?? [];
  const cameras = facets?.cameras ?? [];
  return (
    <search className="image-filters" aria-label="Filter images">
      <SearchField field={searchField} value={view.search} onChange={(search) => onChange({ search })} />
      <Choice
        label="Status"
        value={view.status}
        all="Any status"
        choices={STATUSES.map((value) => ({
          value,
          text: counted(STATUS_WORDS[value], facets?.status[value]),
        }))}
        onChange={(status) => onChange({ status: status as ImageView["status"] })}
      />
      <Choice
        label="Pre-label state"
        value={view.prelabel}
        all="Any pre-label state"
        choices={PRELABELS.filter(
          (value) => view.prelabel === value || (facets?.prelabel[value] ?? 0) > 0,
        ).map((value) => ({ value, text: counted(PRELABEL_WORDS[value], facets?.prelabel[value]) }))}
        onChange={(prelabel) => onChange({ prelabel: prelabel as ImageView["prelabel"] })}
      />
      {sources.length > 1 || view.source !== null ? (
        <Choice
          label="Source"
          value={view.source}
          all="Any source"
          choices={sources.map(({ value, count }) => ({
            value: value ?? "",
            text: counted(value ?? "No source", count),
          }))}
          onChange={(source) => onChange({ source })}
        />
      ) : null}
      {cameras.length > 1 || view.camera !== null ? (
        <Choice
          label="Camera"
          value={view.camera === null ? null : String(view.camera)}
          all="Any camera"
          choices={cameras.map(({ id, name, count }) => ({ value: String(id), text: counted(name, count) }))}
          onChange={(camera) => onChange({ camera: camera === null ? null : Number(camera) })}
        />
      ) : null}
      {sequences.length > 1 || view.sequence !== null ? (
        <Choice
          label="Sequence"
          value={view.sequence}
          all="Any sequence"
          choices={sequences.map(({ value, count }) => ({
            value: value ?? "",
            text: counted(value ?? "No sequence", count),
          }))}
          onChange={(sequence) => onChange({ sequence })}
        />
      ) : null}
      <MoreFilters slug={slug} view={view} onChange={onChange} />
      {isFiltered(view) ? (
        <Button tone="quiet" icon="cross" onClick={() => onChange(EVERYTHING)}>
          Clear
        </Button>
      ) : null}
      <span className="image-filters__count muted numeric" aria-live="polite">
        {countText}
      </span>
      <Choice
        label="Order"
        value={view.sort}
        choices={SORTS.map((value) => ({ value, text: SORT_WORDS[value] }))}
        onChange={(sort) => onChange({ sort: (sort ?? "name") as ImageView["sort"] })}
      />
      <Segmented
        label="Size of the pictures"
        name="grid-size"
        value={size}
        onChange={onSize}
        choices={[
          { value: "small", label: <Icon name="grid" />, title: "Small pictures" },
          { value: "large", label: <Icon name="gridLarge" />, title: "Large pictures" },
        ]}
      />
    </search>
  );
}

interface ChoiceProps {
  label: string;
  value: string | null;
  /** What stands for no choice; absent where there always is one. */
  all?: string;
  choices: { value: string; text: string }[];
  onChange: (value: string | null) => void;
}

const ANY = "\u0000any";

function Choice({ label, value, all, choices, onChange }: ChoiceProps) {
  return (
    <select
      className={`input image-filters__choice${all && value !== null ? " image-filters__choice--set" : ""}`}
      aria-label={label}
      value={value ?? ANY}
      onChange={(event) => onChange(event.target.value === ANY ? null : event.target.value)}
    >
      {all ? <option value={ANY}>{all}</option> : null}
      {choices.map((choice) => (
        <option key={choice.value} value={choice.value}>
          {choice.text}
        </option>
      ))}
    </select>
  );
}

interface SearchFieldProps {
  field: RefObject<HTMLInputElement | null>;
  value: string;
  onChange: (text: string) => void;
}

/** Says what is searched for once the typing pauses; follows the address where it changes otherwise. */
function SearchField({ field, value, onChange }: SearchFieldProps) {
  const [text, setText] = useState(value);
  useEffect(() => setText(value), [value]);
  useEffect(() => {
    if (text === value) return;
    const timer = setTimeout(() => onChange(text), TYPING_MS);
    return () => clearTimeout(timer);
  }, [text, value, onChange]);
  return (
    <input
      ref={field}
      className="input image-filters__search"
      type="search"
      placeholder="Search names  ( / )"
      aria-label="Search image names"
      maxLength={300}
      value={text}
      onChange={(event) => setText(event.target.value)}
      onKeyDown={(event) => {
        if (event.key === "Escape") onChange("");
      }}
    />
  );
}

function counted(text: string, count: number | undefined): string {
  return count === undefined ? text : `${text} (${formatCount(count)})`;
}
