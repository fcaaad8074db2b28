/** Parts of a result: strata of lines, and types of errors. */

import type { Measured } from "../../api/board_types";
import { capitalized, formatQuantity } from "../../design/format";
import { REASON_NAMES, REASONS } from "../../labelling/reasons";
import { type ErrorType, FALSE_NEGATIVES, FALSE_POSITIVES } from "../error_type_names";

export interface Stratum {
  name: string;
  f1: Measured;
  precision: Measured;
  recall: Measured;
  tp: number;
  fp: number;
  fn: number;
}

export interface StrataOfKind {
  kind: string;
  title: string;
  strata: Stratum[];
}

const TITLES: Record<string, string> = {
  source: "By source",
  length: "By length",
  orientation: "By orientation",
  distance: "By distance from the centre",
};

/** A kind of its own: of lines that people rejected there are false positives and nothing else. */
const REASON = "reason";

/** What the server says of strata; kinds without lines, or with one stratum alone, say nothing and are left out. */
export function readStrata(given: unknown): StrataOfKind[] {
  if (!isRecord(given)) return [];
  return Object.entries(given).flatMap(([kind, list]) => {
    if (kind === REASON) return [];
    const strata = Array.isArray(list) ? list.flatMap((entry) => readStratum(entry) ?? []) : [];
    const filled = strata.filter(({ tp, fp, fn }) => tp + fp + fn > 0);
    return filled.length < 2 ? [] : [{ kind, title: TITLES[kind] ?? `By ${kind}`, strata: filled }];
  });
}

export interface ErrorCount {
  type: string;
  name: string;
  meaning: string;
  count: number;
}

export interface ErrorsOfSide {
  title: string;
  total: number;
  errors: ErrorCount[];
}

/** Numbers of errors by type, most frequent first. */
export function readErrorTypes(given: unknown): ErrorsOfSide[] {
  if (!isRecord(given)) return [];
  const side = (title: string, types: readonly ErrorType[]): ErrorsOfSide => {
    const errors = types
      .map(({ type, name, meaning }) => ({
        type,
        name: capitalized(name),
        meaning,
        count: Number(given[type] ?? 0),
      }))
      .sort((a, b) => b.count - a.count);
    return { title, total: errors.reduce((sum, { count }) => sum + count, 0), errors };
  };
  return [
    side("False positives: predictions that found no label", FALSE_POSITIVES),
    side("False negatives: labels that weren't found", FALSE_NEGATIVES),
  ];
}

/** False positives that are lines which people rejected with a reason; null where no such lines are known. */
export function readReasons(given: unknown): ErrorsOfSide | null {
  const list = isRecord(given) && Array.isArray(given[REASON]) ? given[REASON].filter(isRecord) : [];
  const errors = REASONS.flatMap((reason) => {
    const found = list.find(({ name }) => name === reason);
    if (found === undefined) return [];
    const candidates = formatQuantity(Number(found.candidates ?? 0), "such line");
    const meaning = `of ${candidates}${shareText(readMeasured(found.share))}`;
    return [{ type: reason, name: REASON_NAMES[reason], meaning, count: Number(found.fp ?? 0) }];
  });
  if (errors.length === 0) return null;
  return {
    title: "False positives on lines that people rejected",
    total: errors.reduce((sum, { count }) => sum + count, 0),
    errors,
  };
}

/** ": 8 % (3 to 15 %)", nothing where it isn't known. */
function shareText({ value, low, high }: Measured): string {
  const percent = (share: number) => Math.round(100 * share);
  if (value === null) return "";
  const interval = low === null || high === null ? "" : ` (${percent(low)} to ${percent(high)} %)`;
  return `: ${percent(value)} %${interval}`;
}

function readStratum(entry: unknown): Stratum | null {
  if (!isRecord(entry) || typeof entry.name !== "string") return null;
  const count = (value: unknown) => (typeof value === "number" ? value : 0);
  return {
    name: entry.name,
    f1: readMeasured(entry.f1),
    precision: readMeasured(entry.precision),
    recall: readMeasured(entry.recall),
    tp: count(entry.tp),
    fp: count(entry.fp),
    fn: count(entry.fn),
  };
}

function readMeasured(given: unknown): Measured {
  const fields = isRecord(given) ? given : { value: given };
  const number = (value: unknown) => (typeof value === "number" ? value : null);
  return { value: number(fields.value), low: number(fields.low), high: number(fields.high) };
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
