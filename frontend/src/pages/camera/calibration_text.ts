/** What is said of calibrations. */

import type {
  CalibrationBrief,
  CalibrationProgress,
  CalibrationSource,
  LensFamily,
  Uncertainty,
} from "../../api/camera_types";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { px } from "./length_text";

export const FAMILIES: Record<LensFamily, { name: string; hint: string }> = {
  brown: { name: "Brown-Conrady", hint: "Corrects by a polynomial of the measured place, as in the paper" },
  opencv: { name: "OpenCV", hint: "Distorts by a polynomial of the corrected place, as most tools do" },
  division: {
    name: "Division",
    hint: "Divides by a polynomial of the radius; few parameters for wide lenses",
  },
};

export const SOURCES: Record<CalibrationSource, string> = {
  labels: "kept lines",
  candidates: "candidates, by their scores",
};

const STAGES: Record<string, string> = {
  fitting: "Fitting the lens",
  ladder: "Trying larger models",
  "leaving images out": "Leaving images out, one by one",
  "focal length": "Looking for vanishing points",
  "free model": "Looking for what the model misses",
};

export function isAtWork({ status }: Pick<CalibrationBrief, "status">): boolean {
  return status === "queued" || status === "running";
}

/** "Fitting the lens, 3 of 12". */
export function progressText(progress: CalibrationProgress | null): string {
  if (progress === null) return "Waiting to start";
  const stage = STAGES[progress.stage] ?? progress.stage;
  return progress.total > 1
    ? `${stage}, ${formatCount(progress.done)} of ${formatCount(progress.total)}`
    : stage;
}

/** "Expected error 0.42 px, below 0.9 px with 95 %". */
export function expectedErrorText({ pred, bound95 }: Pick<Uncertainty, "pred" | "bound95">): string {
  return `Expected error ${px(pred)}, below ${px(bound95)} with 95 %`;
}

/** "Calibrate from 312 kept lines". */
export function calibrateText(kept: number): string {
  return kept === 0 ? "Calibrate" : `Calibrate from ${formatQuantity(kept, "kept line")}`;
}

/** "k1, k2 and the centre". */
export function releasedText(released: readonly string[]): string {
  const named = released.filter((name) => name !== "cx" && name !== "cy");
  const all = named.length < released.length ? [...named, "the centre"] : named;
  if (all.length === 0) return "nothing: no distortion";
  const last = all.at(-1) ?? "";
  return all.length === 1 ? last : `${all.slice(0, -1).join(", ")} and ${last}`;
}

const PARAMETER_FIRST = /^(k\d|p\d|c[xy])\b/;

/** A reason as a sentence; the name of a parameter keeps its small letter. */
export function reasonText(reason: string): string {
  const whole = sentence(reason).replaceAll(/(?<=\s)-(?=\d)/g, "−");
  return PARAMETER_FIRST.test(reason) ? reason.charAt(0) + whole.slice(1) : whole;
}
