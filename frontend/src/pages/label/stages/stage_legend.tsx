import type { ReactNode } from "react";
import type { StageHistory } from "../../../api/types";
import { STAGES } from "../../../canvas/style";

/** What the strokes on the image mean; only those that this candidate has. */
export function StageLegend({ history }: { history: StageHistory }) {
  const { pieces, gap, added } = STAGES;
  const [first, second] = pieces.colours;
  return (
    <ul className="stage-legend">
      <li>
        <Mark>
          <path d="M4 8h9" stroke={first} strokeWidth={pieces.width} />
          <path d="M17 8h9" stroke={history.pieces.length > 1 ? second : first} strokeWidth={pieces.width} />
          <path d="M4 3v10M13 3v10M17 3v10M26 3v10" stroke={STAGES.tick.colour} strokeWidth="1.5" />
        </Mark>
        pieces
      </li>
      {history.joins.length > 0 ? (
        <li>
          <Mark>
            <path
              d="M4 8h22"
              stroke={gap.colour}
              strokeWidth={gap.width}
              strokeDasharray={gap.dash.join(" ")}
            />
          </Mark>
          gaps
        </li>
      ) : null}
      {history.extended[0] + history.extended[1] > 0 ? (
        <li>
          <Mark>
            <path
              d="M5 8h21"
              stroke={added.colour}
              strokeWidth={added.width}
              strokeLinecap="round"
              strokeDasharray={added.dash.join(" ")}
            />
          </Mark>
          extended
        </li>
      ) : null}
    </ul>
  );
}

function Mark({ children }: { children: ReactNode }) {
  return (
    <svg className="line-mark" width="30" height="16" viewBox="0 0 30 16" aria-hidden="true">
      <rect width="30" height="16" rx="3" fill={STAGES.bed.colour} />
      {children}
    </svg>
  );
}
