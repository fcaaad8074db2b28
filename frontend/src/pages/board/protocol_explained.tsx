import { Link } from "react-router";
import type { Split, SplitVersion } from "../../api/board_types";

/** What the rank key counts, in a few lines and a picture. */
export function ProtocolExplained({ split, shown }: { split: Split; shown: SplitVersion }) {
  return (
    <div className="protocol">
      <h2>
        {split.protocol}, version {split.protocol_version}
      </h2>
      <Tolerance />
      <p>
        A prediction finds a label when at least half of their common length lies within 3 px and 15 degrees
        of the other, at every orientation alike. Each label is found once: copies and fragments are false
        positives.
      </p>
      <p>
        Ambiguous labels{split.min_length > 0 ? ` and those shorter than ${split.min_length} px` : ""} are
        neither asked for nor counted against a detector.
      </p>
      <dl className="protocol__facts">
        <dt>Ground truth</dt>
        <dd className="mono" title={shown.truth_hash}>
          {shown.truth_hash.slice(0, 16)}
        </dd>
        <dt>Version</dt>
        <dd>{shown.number}</dd>
      </dl>
      <p>
        <Link to="/docs/scoring">What counts, with pictures</Link>
      </p>
    </div>
  );
}

function Tolerance() {
  return (
    <svg
      className="protocol__picture"
      viewBox="0 0 340 92"
      role="img"
      aria-label="A label with its band of 3 px"
    >
      <path d="M20 52Q170 30 320 46" stroke="var(--accent)" strokeWidth="22" opacity="0.16" fill="none" />
      <path d="M20 52Q170 30 320 46" stroke="var(--accent)" strokeWidth="2.5" fill="none" />
      <path d="M60 45Q170 27 286 37" stroke="var(--success)" strokeWidth="2.5" fill="none" />
      <path d="M70 78L190 14" stroke="var(--danger)" strokeWidth="2.5" strokeDasharray="6 4" fill="none" />
      <g fontSize="11" fill="var(--text-muted)">
        <text x="326" y="64" textAnchor="end">
          label ± 3 px
        </text>
        <text x="286" y="26" textAnchor="end">
          found
        </text>
        <text x="64" y="88">
          wrong angle
        </text>
      </g>
    </svg>
  );
}
