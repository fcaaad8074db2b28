import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { cameraQuery } from "../../api/camera_endpoints";
import type { Camera } from "../../api/types";
import { Badge } from "../../design/badge";
import { formatQuantity } from "../../design/format";
import { calibrateText, expectedErrorText } from "../camera/calibration_text";

/** What a camera's latest calibration says, or what there is to make one from; it leads to the camera's page. */
export function CalibrationNote({ slug, camera }: { slug: string; camera: Camera }) {
  const { data } = useQuery(cameraQuery(camera.id));
  const to = `/datasets/${slug}/cameras/${camera.id}`;
  if (data === undefined) return <p className="camera-card__calibration">{"\u00a0"}</p>;
  const summary = data.latest_calibration?.summary;
  if (data.active_calibration) {
    return (
      <p className="camera-card__calibration">
        <Badge tone="accent" icon="play">
          Calibrating
        </Badge>{" "}
        <Link to={to}>Watch it</Link>
      </p>
    );
  }
  if (!summary) {
    return (
      <p className="camera-card__calibration numeric">
        {data.kept_lines > 0 ? (
          <Link to={to}>{calibrateText(data.kept_lines)}</Link>
        ) : (
          <Link to={to}>No line is kept yet to calibrate from</Link>
        )}
      </p>
    );
  }
  return (
    <p className="camera-card__calibration numeric">
      <Badge tone={summary.accepted ? "success" : "warning"} icon={summary.accepted ? "check" : "warning"}>
        {summary.accepted ? "Calibrated" : "Calibration refused"}
      </Badge>{" "}
      <Link to={to}>
        {expectedErrorText(summary)}, from {formatQuantity(summary.inliers, "line")}
      </Link>
    </p>
  );
}
