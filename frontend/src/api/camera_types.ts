/**
 * The shapes of cameras and their calibrations, under the names the pages use.
 *
 * Coordinates and lengths are in px: x right, y down, the centre of the top left pixel at (0, 0).
 */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type CameraDetail = Schemas["CameraDetail"];
export type CalibrationBrief = Schemas["CalibrationBrief"];
export type CalibrationDetail = Schemas["CalibrationAnswer"];
export type CalibrationResult = Schemas["CalibrationResult"];
/** One that is done. */
export type FinishedCalibration = Omit<CalibrationDetail, "result"> & { result: CalibrationResult };
export type CalibrationProgress = Schemas["CalibrationProgress"];
export type CalibrationSource = Schemas["CalibrationBrief"]["source"];
export type LensFamily = CalibrationResult["lens"]["family"];
export type Uncertainty = Schemas["LensUncertainty"];
export type LadderStep = Schemas["LadderStep"];
export type CalibrationLine = Schemas["CalibrationLine"];
export type CalibrationImage = Schemas["CalibrationImage"];
export type CalibrationLinePage = Schemas["CalibrationLinePage"];
export type ImageLine = Schemas["ImageLine"];
export type ImageLines = Schemas["ImageLines"];
export type LensDifference = Schemas["LensDifference"];
export type Advice = Schemas["Advice"];
export type AdviceCell = Schemas["AdviceCell"];
export type ExportOverview = Schemas["ExportOverview"];
export type ExportOption = Schemas["ExportOption"];
export type Intrinsics = Schemas["IntrinsicsAnswer"];
export type Reference = NonNullable<Schemas["CameraChange"]["reference"]>;
export type LineOrder = "residual" | "length" | "image";

/** Values over the frame, row by row; null where the lens folds. */
export type Grid = readonly (readonly (number | null)[])[];

/** Middles of the columns and rows of a grid over the frame. */
export interface FrameGrid {
  readonly x: readonly number[];
  readonly y: readonly number[];
}
