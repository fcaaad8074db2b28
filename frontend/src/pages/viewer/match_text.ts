/** What is said of scored lines. */

import { REASON_NAMES } from "../../labelling/reasons";
import { errorTypeOf } from "../error_type_names";
import { LAYER_NAMES } from "./layers";
import type { MatchedLine } from "./matched_image";

/** "Prediction 13" or "Label 4": people count from 1. */
export function lineTitle({ kind, name }: Pick<MatchedLine, "kind" | "name">): string {
  return `${kind === "label" ? "Label" : "Prediction"} ${Number(name.slice(1)) + 1}`;
}

export function pixels(value: number | null, digits = 1): string {
  return value === null ? "–" : `${value.toFixed(digits)} px`;
}

export function degrees(radians: number | null): string {
  return radians === null ? "–" : `${((radians * 180) / Math.PI).toFixed(2)}°`;
}

export function ratio(value: number | null): string {
  return value === null ? "–" : value.toFixed(2);
}

/** What people said of the line that a false positive is, when the labels were made; null where they said nothing. */
export function rejectionText({ rejectedAs }: Pick<MatchedLine, "rejectedAs">): string | null {
  return rejectedAs === null ? null : `rejected by hand as: ${REASON_NAMES[rejectedAs].toLowerCase()}`;
}

/** What a screen reader says of the selected line. */
export function describeLine(line: MatchedLine | null, place: number | null, errors: number): string {
  if (line === null) return "No line selected";
  const parts = [`${LAYER_NAMES[line.layer].one}, ${lineTitle(line).toLowerCase()}`];
  if (place !== null) parts.push(`error ${place} of ${errors}`);
  const error = errorTypeOf(line.errorType);
  if (error !== null) parts.push(error.name);
  const rejected = rejectionText(line);
  if (rejected !== null) parts.push(rejected);
  parts.push(`${Math.round(line.length)} pixels long`);
  if (line.liou !== null) parts.push(`L I O U ${line.liou.toFixed(2)}`);
  if (line.offset !== null) parts.push(`${line.offset.toFixed(1)} pixels beside`);
  if (line.angle !== null) parts.push(`${((line.angle * 180) / Math.PI).toFixed(1)} degrees off`);
  if (line.score !== null) parts.push(`score ${line.score.toFixed(2)}`);
  return parts.join(", ");
}
