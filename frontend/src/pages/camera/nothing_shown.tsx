import { Link } from "react-router";
import type { CalibrationBrief, CalibrationDetail, CameraDetail } from "../../api/camera_types";
import { useRights } from "../../api/use_rights";
import { Button, buttonClass } from "../../design/button";
import { formatQuantity, sentence } from "../../design/format";
import { EmptyState } from "../../design/states";
import { calibrateText, isAtWork } from "./calibration_text";
import type { CalibrationActions } from "./use_calibration_actions";

interface NothingShownProps {
  camera: CameraDetail;
  active: CalibrationBrief | null;
  /** What the address asks for, where that has no result. */
  asked: CalibrationDetail | null;
  actions: CalibrationActions;
}

/** In place of a part while there is no calibration: what is missing, and how to get it. */
export function NothingShown({ camera, active, asked, actions }: NothingShownProps) {
  const { maintain } = useRights();
  if (asked !== null && !isAtWork(asked)) {
    return (
      <EmptyState icon="warning" title={`This calibration was ${asked.status}`}>
        {asked.error ? sentence(asked.error.message) : "It has no result to show."}
      </EmptyState>
    );
  }
  if (active !== null) {
    return (
      <EmptyState icon="clock" title="The first calibration is under way">
        Everything about the lens is shown here as soon as it is done.
      </EmptyState>
    );
  }
  if (camera.images === 0) {
    return (
      <EmptyState icon="images" title="This camera has no images">
        A lens is read off the lines in images: add some to the dataset, or give others this camera.
      </EmptyState>
    );
  }
  if (camera.kept_lines === 0) {
    return (
      <EmptyState
        icon="lines"
        title="No line is kept yet"
        actions={
          <Link
            className={buttonClass("primary")}
            to={`/datasets/${camera.dataset.slug}?camera=${camera.id}`}
          >
            Label {formatQuantity(camera.images, "image")}
          </Link>
        }
      >
        A lens is calibrated from lines that somebody kept as straight. About forty long ones from several
        images, near the edges of the frame too, are a good beginning.
      </EmptyState>
    );
  }
  return (
    <EmptyState
      icon="camera"
      title="Not calibrated yet"
      actions={
        maintain ? (
          <Button tone="primary" icon="play" onClick={() => void actions.start("labels", null)}>
            {calibrateText(camera.kept_lines)}
          </Button>
        ) : null
      }
    >
      The images before and after, maps of what is known where, parameters and files for other tools are shown
      here once the lens is calibrated.
    </EmptyState>
  );
}
