/** How long a split takes submissions. */

import type { Split } from "../api/board_types";
import { formatDate, formatQuantity } from "../design/format";

const DAY = 86_400_000;
const HOUR = 3_600_000;

type Closing = Pick<Split, "closes_at" | "closed">;

/** "Closes in 3 days", "Closed"; null where there is no deadline. */
export function deadlineText({ closes_at, closed }: Closing, now: number): string | null {
  if (closed) return "Closed";
  if (closes_at === null) return null;
  const left = Date.parse(closes_at) - now;
  if (left <= 0) return "Closed";
  if (left < HOUR) return `Closes in ${formatQuantity(Math.max(1, Math.round(left / 60_000)), "minute")}`;
  if (left < 2 * DAY) return `Closes in ${formatQuantity(Math.round(left / HOUR), "hour")}`;
  return `Closes in ${formatQuantity(Math.round(left / DAY), "day")}`;
}

/** The same with the very time, for a tooltip. */
export function deadlineTitle({ closes_at }: Closing): string | undefined {
  return closes_at === null ? undefined : formatDate(closes_at);
}
