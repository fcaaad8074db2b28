/** In which order a submission's images are shown; it lives in the address. */

export const IMAGE_COLUMNS = [
  ["name", "Image"],
  ["f1", "F1"],
  ["precision", "P"],
  ["recall", "R"],
  ["tp", "Found"],
  ["fp", "Wrong"],
  ["fn", "Missed"],
  ["offset_mean", "Offset"],
  ["angle_error", "Angle"],
] as const;

export type ImageColumn = (typeof IMAGE_COLUMNS)[number][0];

/** Worst first: that is where there is something to learn. */
export const WORST_FIRST = "f1";

/** Which end of a column comes first at the first press. */
const DESCENDING_FIRST: readonly ImageColumn[] = ["fp", "fn", "tp", "offset_mean", "angle_error"];

export function readImageSort(text: string | null): string {
  const column = (text ?? "").replace(/^-/, "");
  return IMAGE_COLUMNS.some(([name]) => name === column) ? (text ?? WORST_FIRST) : WORST_FIRST;
}

/** The order after a press on a column's head. */
export function nextImageSort(current: string, column: ImageColumn): string {
  if (current === column) return `-${column}`;
  if (current === `-${column}`) return column;
  return DESCENDING_FIRST.includes(column) ? `-${column}` : column;
}
