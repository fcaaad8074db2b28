/** Rows of a board: in which order, and what is said of their ranks. */

import type { BoardRow } from "../../api/board_types";
import { metricOf } from "../metrics";

/** The columns of numbers, in their order. */
export const METRIC_COLUMNS = [
  "f1",
  "precision",
  "recall",
  "mean_f1",
  "ap",
  "quality",
  "offset_mean",
  "calibration_rms",
] as const;

export const OFFICIAL_COLUMNS = ["official_f1", "official_precision", "official_recall"] as const;

const TEXT_COLUMNS = ["rank", "method", "date"] as const;
const ALL: readonly string[] = [...TEXT_COLUMNS, ...METRIC_COLUMNS, ...OFFICIAL_COLUMNS];

export interface Sort {
  column: string;
  descending: boolean;
}

export const BY_RANK: Sort = { column: "rank", descending: false };

/** The order that an address asks for: "f1", "-f1"; by rank where it asks for none or can't mean one. */
export function readSort(text: string | null): Sort {
  if (text === null) return BY_RANK;
  const column = text.replace(/^-/, "");
  return ALL.includes(column) ? { column, descending: text.startsWith("-") } : BY_RANK;
}

/** How an order stands in the address; null for the one by rank. */
export function sortText({ column, descending }: Sort): string | null {
  if (column === BY_RANK.column && !descending) return null;
  return descending ? `-${column}` : column;
}

/** The order after a press on a column's head: its best first, then turned round. */
export function nextSort(current: Sort, column: string): Sort {
  if (current.column === column) return { column, descending: !current.descending };
  return { column, descending: bestFirst(column) };
}

/**
 * Sorted anew; rows without a value stay at the end, equal ones in the order they had.
 *
 * Among rows of the same best rank the higher F1 comes first, whichever way the ranks run: how wide an interval of ranks
 * is says how sure it is, not how good.
 */
export function sortRows(rows: readonly BoardRow[], { column, descending }: Sort): BoardRow[] {
  const sign = descending ? -1 : 1;
  return rows
    .map((row) => ({ row, key: sortKey(row, column) }))
    .sort((a, b) => {
      if (a.key === null || b.key === null) return Number(a.key === null) - Number(b.key === null);
      return sign * compare(a.key, b.key) || (column === "rank" ? compareF1(a.row, b.row) : 0);
    })
    .map(({ row }) => row);
}

/** The metrics of which some row has a value. */
export function knownMetrics(rows: readonly BoardRow[], columns: readonly string[]): string[] {
  return columns.filter((key) => rows.some((row) => totalOf(row, key) !== null));
}

export function totalOf(row: BoardRow, key: string): number | null {
  return row.totals[key]?.value ?? null;
}

/** "1", "1–3", or a dash for what isn't ranked. */
export function rankText({ rank_low, rank_high }: Pick<BoardRow, "rank_low" | "rank_high">): string {
  if (rank_low === null || rank_high === null) return "–";
  return rank_low === rank_high ? String(rank_low) : `${rank_low}–${rank_high}`;
}

/** More names than these are counted. */
const NAMED = 5;

/** Whom a row can't be told apart from: "Tied with A, B and 12 others"; null where it can from all. */
export function tiedText({ tied_with }: BoardRow, rows: readonly BoardRow[]): string | null {
  if (tied_with.length === 0) return null;
  const named = tied_with.length > NAMED + 1 ? tied_with.slice(0, NAMED) : tied_with;
  const names = named.map((slug) => rows.find(({ method }) => method.slug === slug)?.method.name ?? slug);
  const others = tied_with.length - named.length;
  return `Tied with ${names.join(", ")}${others > 0 ? ` and ${others} others` : ""}`;
}

/** The highest F1 of somebody's entry; of a baseline where there is no entry yet. */
export function bestRow(rows: readonly BoardRow[]): BoardRow | null {
  const byF1 = sortRows(rows, { column: "f1", descending: true }).filter(
    (row) => totalOf(row, "f1") !== null,
  );
  return (
    byF1.find(({ method }) => method.kind === "method") ??
    byF1.find(({ method }) => method.kind === "baseline") ??
    null
  );
}

function bestFirst(column: string): boolean {
  if (column === "rank" || column === "method") return false;
  return column === "date" || metricOf(column).best === "higher";
}

function sortKey(row: BoardRow, column: string): string | number | null {
  if (column === "rank") return row.rank_low;
  if (column === "method") return row.method.name.toLocaleLowerCase();
  if (column === "date") return row.scored_at === null ? null : Date.parse(row.scored_at);
  return totalOf(row, column);
}

/** The higher F1 first; without one, last. */
function compareF1(a: BoardRow, b: BoardRow): number {
  return (totalOf(b, "f1") ?? -1) - (totalOf(a, "f1") ?? -1);
}

function compare(a: string | number, b: string | number): number {
  if (typeof a === "string" && typeof b === "string") return a.localeCompare(b);
  return Number(a) - Number(b);
}
