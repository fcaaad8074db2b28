/** What five more lines in a cell of the frame would do, in words. */

import type { AdviceCell } from "../../../api/camera_types";
import { px } from "../length_text";

export function adviceText({ x, y, sigma_now, sigma_with, halves }: AdviceCell): string {
  const place = `(${Math.round(x)}, ${Math.round(y)})`;
  if (halves) {
    return `Five more lines around ${place} would halve the uncertainty there: ${px(sigma_with)} instead of ${px(sigma_now)}.`;
  }
  const less = Math.round(100 * (1 - sigma_with / sigma_now));
  return `Five more lines around ${place} would take ${less} % of the uncertainty there: ${px(sigma_with)} instead of ${px(sigma_now)}.`;
}
