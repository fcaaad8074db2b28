import { Link } from "react-router";
import type { CalibrationBrief } from "../../../api/camera_types";
import { useRights } from "../../../api/use_rights";
import { Badge } from "../../../design/badge";
import { IconButton } from "../../../design/button";
import { formatCount, formatDate } from "../../../design/format";
import { FAMILIES, isAtWork, progressText, releasedText } from "../calibration_text";
import { digits } from "../length_text";

interface HistoryRowProps {
  entry: CalibrationBrief;
  shown: boolean;
  compared: boolean;
  to: string;
  onCompare: () => void;
  onRemove: () => void;
}

/** One calibration in the table of all. */
export function HistoryRow({ entry, shown, compared, to, onCompare, onRemove }: HistoryRowProps) {
  const { maintain } = useRights();
  const { id, summary, status, error, person, finished_at, created_at } = entry;
  return (
    <tr className={shown ? "history__shown" : undefined}>
      <th scope="row">
        {summary ? <Link to={to}>Calibration {id}</Link> : `Calibration ${id}`}
        <span className="table__small history__when">
          {formatDate(finished_at ?? created_at)}
          {person ? ` · ${person}` : ""}
          {entry.source === "candidates" ? " · from candidates" : ""}
        </span>
      </th>
      <td>
        {isAtWork(entry) ? (
          <Badge tone="accent" icon="play">
            {progressText(entry.progress)}
          </Badge>
        ) : summary === null ? (
          <span title={error?.message}>
            <Badge
              tone={status === "failed" ? "danger" : "neutral"}
              icon={status === "failed" ? "warning" : "stop"}
            >
              {status === "failed" ? "Failed" : "Cancelled"}
            </Badge>
          </span>
        ) : summary.accepted ? (
          <Badge tone="success" icon="check">
            Accepted
          </Badge>
        ) : (
          <Badge tone="warning" icon="warning">
            Refused
          </Badge>
        )}
      </td>
      <td>
        {summary ? (
          <>
            {FAMILIES[summary.family].name}
            <span className="table__small history__when">{releasedText(summary.released)}</span>
          </>
        ) : (
          "–"
        )}
      </td>
      <td className="table__number">
        {summary ? formatCount(summary.inliers) : formatCount(entry.n_segments)}
      </td>
      <td className="table__number">{summary ? digits(summary.pred) : "–"}</td>
      <td className="table__number">{summary ? digits(summary.bound95) : "–"}</td>
      <td className="table__number">
        {summary && !shown ? (
          <IconButton
            small
            icon="compare"
            label={`Compare calibration ${id} with the one shown`}
            side="end"
            aria-pressed={compared}
            tone={compared ? "default" : "quiet"}
            onClick={onCompare}
          />
        ) : null}
        {maintain && !isAtWork(entry) ? (
          <IconButton small icon="trash" label={`Delete calibration ${id}`} side="end" onClick={onRemove} />
        ) : null}
      </td>
    </tr>
  );
}
