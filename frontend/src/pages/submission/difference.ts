import type { Difference } from "../../api/board_types";

/** A difference seen from the first of two submissions: a - b, where the server gives b - a. */
export function turned({ a, b, difference, low, high, tied }: Difference): Difference {
  return { a, b, difference: minus(difference), low: minus(high), high: minus(low), tied };
}

function minus(value: number | null): number | null {
  // Not -0, which would be shown with its sign.
  return value === null ? null : 0 - value;
}
