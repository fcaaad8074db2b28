/** Labels that no run proposed, imported or drawn by hand: nothing among them waits for a verdict. */

import type { Dataset, ImageSummary } from "../api/types";
import { formatCount, formatQuantity } from "../design/format";

type Counted = Pick<Dataset, "candidates" | "verdicts" | "latest_run">;

export function cameLabelled({ candidates, verdicts, latest_run }: Counted): boolean {
  return latest_run === null && candidates > 0 && verdicts.undecided === 0;
}

/** "5,563 labels" where they were imported, else "8,120 candidates"; null without either. */
export function segmentsText(dataset: Counted): string | null {
  if (dataset.candidates === 0) return null;
  if (cameLabelled(dataset)) return formatQuantity(dataset.verdicts.keep, "label");
  return formatQuantity(dataset.candidates, "candidate");
}

/** How far the labels go, where they were imported: "Labelled", or "3 of 100 images labelled". */
export function labelledText({ images, prelabelled }: Pick<Dataset, "images" | "prelabelled">): string {
  if (prelabelled >= images) return "Labelled";
  return `${formatCount(prelabelled)} of ${formatQuantity(images, "image")} labelled`;
}

/** The same of one image: "12 labels" or "40 candidates". */
export function imageSegmentsText(image: Pick<ImageSummary, "candidates" | "verdicts" | "prelabel">): string {
  if (imageCameLabelled(image)) return formatQuantity(image.verdicts.keep, "label");
  return formatQuantity(image.candidates, "candidate");
}

export function imageCameLabelled({
  candidates,
  verdicts,
  prelabel,
}: Pick<ImageSummary, "candidates" | "verdicts" | "prelabel">): boolean {
  return prelabel === "none" && candidates > 0 && verdicts.undecided === 0;
}
