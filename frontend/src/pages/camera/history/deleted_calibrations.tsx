import { useQuery } from "@tanstack/react-query";
import { deletedCalibrationsQuery } from "../../../api/camera_endpoints";
import type { CameraDetail } from "../../../api/camera_types";
import { Button } from "../../../design/button";
import { formatDay, formatQuantity } from "../../../design/format";
import { px } from "../length_text";
import type { CalibrationActions } from "../use_calibration_actions";

interface DeletedCalibrationsProps {
  camera: CameraDetail;
  actions: CalibrationActions;
}

/** What was deleted lately and can be had back. */
export function DeletedCalibrations({ camera, actions }: DeletedCalibrationsProps) {
  const { data = [] } = useQuery(deletedCalibrationsQuery(camera.id));
  if (data.length === 0) return null;
  return (
    <details className="history__deleted">
      <summary>{formatQuantity(data.length, "deleted calibration")}</summary>
      <ul>
        {data.map(({ id, summary, restorable_until }) => (
          <li key={id}>
            <span className="numeric">
              Calibration {id}
              {summary ? `, expected error ${px(summary.pred)}` : ""}
              {restorable_until ? `, kept until ${formatDay(restorable_until)}` : ""}
            </span>
            <Button small icon="undo" onClick={() => void actions.restore(id)}>
              Restore
            </Button>
          </li>
        ))}
      </ul>
    </details>
  );
}
