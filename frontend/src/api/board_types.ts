/**
 * The shapes of splits, submissions, methods and boards, under the names the pages use.
 *
 * Lengths are in px, angles in rad, times ISO-8601 in UTC.
 */

import type { components } from "./schema";

type Schemas = components["schemas"];

/** Who asks, and what they may do. */
export type Me = Schemas["Me"];
export type Role = Me["role"];

export type Split = Schemas["SplitAnswer"];
export type SplitVersion = Schemas["SplitVersionAnswer"];
export type NewSplit = Pick<Schemas["SplitGiven"], "name"> & Partial<Schemas["SplitGiven"]>;
export type SplitChanges = Schemas["SplitChange"];
export type Visibility = Split["visibility"];

/** A number and the ends of its interval. */
export type Measured = Schemas["Estimate"];
export type Totals = Record<string, Measured>;

export type Board = Schemas["BoardAnswer"];
export type BoardRow = Schemas["BoardRow"];
export type MethodName = Schemas["MethodName"];
export type MethodKind = MethodName["kind"];
export type Method = Schemas["MethodAnswer"];
export type MethodChanges = Schemas["MethodChange"];

export type Submission = Schemas["SubmissionAnswer"];
export type SubmissionPage = Schemas["SubmissionPage"];
export type SubmissionStatus = Submission["status"];
export type SubmissionChanges = Schemas["SubmissionChange"];
export type Score = Schemas["ScoreAnswer"];
/** F1 over distances tau and thresholds t, which mean F1 is the mean of. */
export type F1Grid = Schemas["F1Grid"];
export type Validation = Schemas["Validation"];

/** One thing that is wrong with an upload; problem documents list them under `details.errors`. */
export interface UploadError {
  file: string | null;
  segment: number | null;
  point: number | null;
  message: string;
  expected: string | null;
  hint: string | null;
}

export type ScoredImage = Schemas["ImageScoreAnswer"];
export type ScoredImagePage = Schemas["ImageScorePage"];
/** Of two submissions; the difference is b - a. */
export type Difference = Schemas["MetricDifference"];
/** Its images count for the second submission: on how many it is better, worse or equal. */
export type Comparison = Schemas["ComparisonAnswer"];

export type Card = Schemas["Card"];
