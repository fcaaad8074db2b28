/** The shapes of one scored image: what became of each label and of each prediction. Lengths in px, angles in rad. */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type ScoredImageDetail = Schemas["ScoredImageAnswer"];
export type ScoredLabel = Schemas["LabelOutcome"];
export type ScoredPrediction = Schemas["PredictionOutcome"];
export type Outcome = ScoredLabel["outcome"];
