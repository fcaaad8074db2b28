import { useQueryClient } from "@tanstack/react-query";
import { useMemo, useRef } from "react";
import {
  cameraKeys,
  cancelCalibration,
  deleteCalibration,
  restoreCalibration,
  startCalibration,
} from "../../api/camera_endpoints";
import type { CalibrationSource, CameraDetail, LensFamily } from "../../api/camera_types";
import { keys } from "../../api/queries";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

/** What can be done with a camera's calibrations; lists follow, a failure is shown. */
export function useCalibrationActions(camera: Pick<CameraDetail, "id" | "dataset">, onStarted: () => void) {
  const client = useQueryClient();
  const started = useRef(onStarted);
  started.current = onStarted;
  const { id: cameraId } = camera;
  const { slug } = camera.dataset;
  return useMemo(() => {
    const doing = async (action: () => Promise<unknown>): Promise<boolean> => {
      let done = true;
      try {
        await action();
      } catch (error) {
        failed(error);
        done = false;
      }
      await Promise.all([
        client.invalidateQueries({ queryKey: cameraKeys.camera(cameraId) }),
        client.invalidateQueries({ queryKey: keys.cameras(slug) }),
      ]);
      return done;
    };
    const restore = (id: number) => doing(() => restoreCalibration(id));
    return {
      restore,
      start: (source: CalibrationSource, family: LensFamily | null) =>
        doing(async () => {
          await startCalibration(cameraId, source, family);
          started.current();
        }),
      cancel: (id: number) => doing(() => cancelCalibration(id)),
      remove: (id: number) =>
        doing(async () => {
          await deleteCalibration(id);
          toast({
            message: "Calibration deleted.",
            action: { label: "Undo", run: () => void restore(id) },
            duration: 10_000,
            key: `calibration-${id}`,
          });
        }),
    };
  }, [client, cameraId, slug]);
}

export type CalibrationActions = ReturnType<typeof useCalibrationActions>;
