import type { Measure } from "../../../labelling/ranges";

/** An end with its unit: "60 px", "0.35", "1.20 px". */
export function endText(measure: Measure, end: number): string {
  if (measure === "score") return end.toFixed(2);
  return `${measure === "length" ? end.toFixed(0) : end.toFixed(2)} px`;
}
