/** What of a dataset's images is shown and in which order; it lives in the page's address. */

import type { ImageFilter } from "../../api/endpoints";
import type { PrelabelStatus, ReviewStatus, Verdict } from "../../api/types";

export const STATUSES = ["open", "done", "discarded", "deleted"] as const;
export const PRELABELS = ["none", "queued", "running", "done", "failed", "cancelled"] as const;
export const VERDICTS = ["keep", "reject", "ambiguous", "undecided"] as const;
export const SORTS = ["name", "-name", "-created", "created", "-candidates", "candidates"] as const;

export interface ImageView {
  status: ReviewStatus | "deleted" | null;
  prelabel: PrelabelStatus | null;
  /** Empty for images without a source. */
  source: string | null;
  sequence: string | null;
  camera: number | null;
  /** Whose task; empty for images that are nobody's. */
  assignee: string | null;
  /** Who decided on some of the candidates. */
  person: string | null;
  /** That at least one candidate has. */
  verdict: Verdict | null;
  /** That at least one candidate's score lies between. */
  min_score: number | null;
  max_score: number | null;
  search: string;
  sort: (typeof SORTS)[number];
}

const NAMES = [
  "status",
  "prelabel",
  "source",
  "sequence",
  "camera",
  "assignee",
  "person",
  "verdict",
  "min_score",
  "max_score",
  "search",
  "sort",
] as const;

/** The view that an address asks for; what it can't mean is left out. */
export function readView(parameters: URLSearchParams): ImageView {
  const camera = Number(parameters.get("camera"));
  return {
    status: oneOf(STATUSES, parameters.get("status")),
    prelabel: oneOf(PRELABELS, parameters.get("prelabel")),
    source: parameters.get("source"),
    sequence: parameters.get("sequence"),
    camera: Number.isInteger(camera) && camera > 0 ? camera : null,
    assignee: parameters.get("assignee"),
    person: parameters.get("person"),
    verdict: oneOf(VERDICTS, parameters.get("verdict")),
    min_score: scoreOf(parameters.get("min_score")),
    max_score: scoreOf(parameters.get("max_score")),
    search: parameters.get("search") ?? "",
    sort: oneOf(SORTS, parameters.get("sort")) ?? "name",
  };
}

/** The address with some of the view changed; defaults aren't written, other parameters stay. */
export function writeView(parameters: URLSearchParams, changes: Partial<ImageView>): URLSearchParams {
  const view = { ...readView(parameters), ...changes };
  const next = new URLSearchParams(parameters);
  for (const name of NAMES) {
    const value = view[name];
    const isDefault =
      value === null || (name === "search" && value === "") || (name === "sort" && value === "name");
    if (isDefault) next.delete(name);
    else next.set(name, String(value));
  }
  return next;
}

export const EVERYTHING: Omit<ImageView, "sort"> = {
  status: null,
  prelabel: null,
  source: null,
  sequence: null,
  camera: null,
  assignee: null,
  person: null,
  verdict: null,
  min_score: null,
  max_score: null,
  search: "",
};

/** True where the view may leave out images. */
export function isFiltered(view: ImageView): boolean {
  const { sort: _, search, ...filters } = view;
  return search !== "" || Object.values(filters).some((value) => value !== null);
}

export function toFilter({ status, search, ...rest }: ImageView): ImageFilter {
  return {
    ...rest,
    status: status === "deleted" ? null : status,
    deleted: status === "deleted",
    search: search === "" ? null : search,
  };
}

function scoreOf(text: string | null): number | null {
  const score = Number.parseFloat(text ?? "");
  return score >= 0 && score <= 1 ? score : null;
}

function oneOf<T extends string>(known: readonly T[], value: string | null): T | null {
  return known.find((candidate) => candidate === value) ?? null;
}
