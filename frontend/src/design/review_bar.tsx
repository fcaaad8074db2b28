import type { Dataset } from "../api/types";
import { formatCount } from "./format";

type ReviewCounts = Dataset["reviewed"];

/** How far the people are: done, discarded and open images side by side. */
export function ReviewBar({ counts }: { counts: ReviewCounts }) {
  const { done, discarded, open } = counts;
  return (
    <span
      className="stacked-bar"
      role="img"
      aria-label={`${done} done, ${discarded} discarded, ${open} open`}
    >
      {done > 0 ? <span style={{ flexGrow: done, background: "var(--success)" }} /> : null}
      {discarded > 0 ? <span style={{ flexGrow: discarded, background: "var(--warning)" }} /> : null}
      <span style={{ flexGrow: open }} />
    </span>
  );
}

/** "4 of 15 done, 1 discarded". */
export function reviewText({ done, discarded, open }: ReviewCounts): string {
  const total = done + discarded + open;
  const first = `${formatCount(done)} of ${formatCount(total)} done`;
  return discarded > 0 ? `${first}, ${formatCount(discarded)} discarded` : first;
}
