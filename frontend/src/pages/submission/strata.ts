/** Parts of a result: strata of lines, and types of errors. */

import type { Measured } from "../../api/board_types";
import { capitalized } from "../../design/format";
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

/** What the server says of strata; kinds without lines, or with one stratum alone, say nothing and are left out. */
export function readStrata(given: unknown): StrataOfKind[] {
  if (!isRecord(given)) return [];
  return Object.entries(given).flatMap(([kind, list]) => {
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
