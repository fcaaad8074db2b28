/**
 * The shapes the server answers with, under the names the pages use.
 *
 * `schema.ts` is generated from the server's OpenAPI (`npm run types`). Times are ISO-8601 in UTC; lengths and
 * coordinates are in px.
 */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type Problem = Omit<Schemas["Problem"], "type" | "details"> &
  Partial<Pick<Schemas["Problem"], "type" | "details">>;
/** What went wrong with one file or one image; a problem without a status of its own. */
export type ErrorInfo = Schemas["ErrorInfo"];

export type Configuration = Schemas["Configuration"];
export type Dataset = Schemas["DatasetAnswer"];
export type ImageSummary = Schemas["ImageSummary"];
export type ImageDetail = Schemas["ImageDetail"];
export type ImagePage = Schemas["ImagePage"];
export type UploadReport = Schemas["UploadReport"];
export type Facets = Schemas["Facets"];
export type Camera = Schemas["CameraAnswer"];
export type Deleted = Schemas["Deleted"];

export type Run = Schemas["RunAnswer"];
export type RunSummary = Schemas["RunBrief"];
export type RunImage = Schemas["RunImageAnswer"];
export type RunChanges = Schemas["RunChanges"];

export type ImageSegments = Schemas["SegmentsAnswer"];
export type SegmentFacts = Schemas["SegmentAnswer"];
export type StoredDecision = Schemas["DecisionAnswer"];
/** What speaks for a candidate, measured along it. */
export type Evidence = Schemas["Evidence"];
/** How the pipeline found a candidate. */
export type StageHistory = Schemas["StageHistory"];
export type StageJoin = Schemas["Join"];
export type ScorePart = Schemas["ScorePart"];
/** What a model suggests for the candidates of an image, and for one of them. */
export type ImageSuggestions = Schemas["ImageSuggestions"];
export type SuggestedCandidate = Schemas["Suggestion"];
export type SuggestionThresholds = Schemas["Thresholds"];
export type SuggestionModelName = Schemas["ModelName"];
export type DatasetSuggestions = Schemas["DatasetSuggestions"];
export type NewDecision = Schemas["DecisionGiven"];
export type DecisionsStored = Schemas["DecisionsStored"];

/** A hand's edit: segments replaced by others, undone and done again as a group of decisions. */
export type NewEdit = Schemas["EditGiven"];
export type Edit = Schemas["EditAnswer"];
export type EditKind = Edit["kind"];
/** An edge as traced between clicked points, with nothing stored. */
export type Trace = Schemas["TraceAnswer"];

export type Verdict = SegmentFacts["verdict"];
/** How much of what is straight an image's labels hold. */
export type Recall = NonNullable<Schemas["ReviewGiven"]["recall"]>;
/** Why a candidate was rejected. */
export type RejectReason = NonNullable<SegmentFacts["reason"]>;
export type VerdictCounts = Schemas["VerdictCounts"];
export type DecisionKind = StoredDecision["kind"];
export type ReviewStatus = ImageSummary["status"];
export type PrelabelStatus = ImageSummary["prelabel"];
