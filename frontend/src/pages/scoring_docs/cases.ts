import given from "./cases.json";

/** Lines of one picture and what the scorers say of them; the numbers are checked against the scorers by a test. */
export interface ScoringCase {
  title: string;
  says: string;
  /** The label is one that isn't scored. */
  ambiguous: boolean;
  /** Polylines, px. */
  labels: number[][][];
  predictions: number[][][];
  /** For each prediction. */
  found: boolean[];
  tp: number;
  fp: number;
  fn: number;
  /** Null where the protocol has no such labels. */
  official_precision: number | null;
  official_recall: number | null;
}

export const CASES: readonly ScoringCase[] = given;
