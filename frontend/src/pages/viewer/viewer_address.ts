/** What the address says of the view: with whom to compare, what is shown, which line is selected. */

import type { ImageList } from "../../api/viewer_endpoints";
import type { Side } from "./difference";
import { DEFAULT_ORDER, ERROR_ORDERS, type ErrorOrder } from "./errors";
import { readLayers, type ShownLayers, writeLayers } from "./layers";

/** Images are listed as on the submission page. */
export interface ViewerAddress extends ImageList {
  /** The submission to compare with. */
  readonly other: number | null;
  readonly shown: ShownLayers;
  /** "p12", "l3"; null without a selection. */
  readonly segment: string | null;
  /** The submission that is looked at: the address's own one is a. */
  readonly side: Side;
  readonly order: ErrorOrder | null;
  readonly sideBySide: boolean;
  readonly differences: boolean;
}

export function readAddress(search: string): ViewerAddress {
  const parameters = new URLSearchParams(search);
  const segment = parameters.get("segment") ?? "";
  const other = parameters.get("with") ?? "";
  const order = parameters.get("order");
  return {
    sort: parameters.get("sort") || null,
    search: parameters.get("search") || null,
    other: /^\d+$/.test(other) ? Number(other) : null,
    shown: readLayers(parameters.get("show")),
    segment: /^[pl]\d+$/.test(segment) ? segment : null,
    side: parameters.get("side") === "b" ? "b" : "a",
    order: ERROR_ORDERS.find((known) => known === order) ?? null,
    sideBySide: parameters.get("view") === "both",
    differences: parameters.has("differences"),
  };
}

/** The parameters that differ from what is shown without any. */
export function writeAddress(address: ViewerAddress): string {
  const parameters = new URLSearchParams();
  const set = (name: string, value: string | null) => value !== null && parameters.set(name, value);
  set("sort", address.sort);
  set("search", address.search);
  set("order", address.order === DEFAULT_ORDER ? null : address.order);
  set("show", writeLayers(address.shown));
  if (address.other !== null) {
    set("with", String(address.other));
    set("side", address.side === "b" ? "b" : null);
    set("view", address.sideBySide ? "both" : null);
    set("differences", address.differences ? "1" : null);
  }
  set("segment", address.segment);
  const text = parameters.toString();
  return text === "" ? "" : `?${text}`;
}

/** The submission's page; with the list of images that one came from, if one did. */
export function submissionPath(submission: number, { sort, search }: ImageList): string {
  const page = `/submissions/${submission}`;
  if (sort === null && search === null) return page;
  const parameters = new URLSearchParams({ tab: "images" });
  if (sort !== null) parameters.set("sort", sort);
  if (search !== null) parameters.set("search", search);
  return `${page}?${parameters}`;
}

export function viewerPath(submission: number, image: number, query = ""): string {
  return `/submissions/${submission}/images/${image}${query}`;
}
