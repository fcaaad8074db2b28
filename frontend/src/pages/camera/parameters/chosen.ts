/** Which of the models that were tried is the lens. */

import type { CalibrationResult, LadderStep } from "../../../api/camera_types";

/** Whether a step's model is the one that the lens has in the end. */
export function isChosen(
  step: Pick<LadderStep, "family" | "released" | "accepted">,
  { lens, released }: { lens: Pick<CalibrationResult["lens"], "family">; released: readonly string[] },
): boolean {
  const same =
    step.released.length === released.length && step.released.every((name) => released.includes(name));
  return step.accepted && same && step.family === lens.family;
}
