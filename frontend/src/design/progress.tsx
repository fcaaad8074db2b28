import type { VerdictCounts } from "../api/types";

interface ProgressProps {
  value: number;
  total: number;
  label: string;
  tone?: "accent" | "success" | "danger";
}

/** A bar from 0 to `total`; without a total it only says that something is going on. */
export function Progress({ value, total, label, tone = "accent" }: ProgressProps) {
  const known = total > 0;
  const width = known ? `${(100 * Math.min(value, total)) / total}%` : undefined;
  return (
    <span
      className={`progress progress--${tone}${known ? "" : " progress--indeterminate"}`}
      role="progressbar"
      aria-label={label}
      aria-valuemin={0}
      {...(known ? { "aria-valuemax": total, "aria-valuenow": value } : {})}
    >
      <span className="progress__fill" style={{ width }} />
    </span>
  );
}

const SHOWN = ["keep", "ambiguous", "reject", "undecided"] as const;

/** The shares of the verdicts, side by side. */
export function VerdictBar({ counts }: { counts: VerdictCounts }) {
  const text = SHOWN.map((verdict) => `${counts[verdict]} ${verdict}`).join(", ");
  return (
    <span className="stacked-bar" role="img" aria-label={text}>
      {SHOWN.map((verdict) =>
        counts[verdict] > 0 && verdict !== "undecided" ? (
          <span key={verdict} style={{ flexGrow: counts[verdict], background: `var(--${verdict})` }} />
        ) : null,
      )}
      <span style={{ flexGrow: counts.undecided }} />
    </span>
  );
}
