/** How many lines a free model takes, in words. */

import type { CalibrationResult } from "../../../api/camera_types";
import { formatCount, formatQuantity } from "../../../design/format";

/** What the server says where no number of lines would do. */
const NEVER = 100_000;

export function enoughText({
  lines,
  needed,
}: Pick<NonNullable<CalibrationResult["free"]>, "lines" | "needed">): string {
  if (needed >= NEVER) return "No number of lines such as these would do.";
  const all = `about ${formatQuantity(needed, "line")} such as these`;
  return lines < needed
    ? `It takes ${all}; there are ${formatCount(lines)}.`
    : `Fitted to ${formatQuantity(lines, "line")}, where ${all} are enough.`;
}
