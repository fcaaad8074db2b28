import type { CameraDetail, FinishedCalibration } from "../../api/camera_types";

/** What each part of the page is given. */
export interface PartProps {
  camera: CameraDetail;
  calibration: FinishedCalibration;
}
