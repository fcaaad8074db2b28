import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef } from "react";
import { calibrationQuery, calibrationsQuery, cameraKeys, getCalibration } from "../../api/camera_endpoints";
import type { CalibrationBrief, CameraDetail } from "../../api/camera_types";
import { keys } from "../../api/queries";
import { isAtWork } from "./calibration_text";

/** How often the one at work is asked how far it is (ms). */
const POLL = 700;

/** A camera's calibrations, newest first; the one at work is followed until it is over, or the server is `lost`. */
export function useCalibrations(camera: CameraDetail) {
  const client = useQueryClient();
  const history = useQuery({ ...calibrationsQuery(camera.id), refetchOnMount: "always" });
  const active = history.data?.find(isAtWork) ?? null;
  const activeId = active?.id ?? null;

  const following = useQuery({
    queryKey: ["cameras", camera.id, "at-work", activeId],
    enabled: activeId !== null,
    refetchInterval: POLL,
    queryFn: async () => {
      const now = await getCalibration(activeId ?? 0);
      client.setQueryData<CalibrationBrief[]>(cameraKeys.calibrations(camera.id), (old) =>
        old?.map((other) => (other.id === now.id ? now : other)),
      );
      return now.status;
    },
  });

  // The camera's own numbers, and its card among the others, are other ones once it is over.
  const before = useRef(activeId);
  useEffect(() => {
    if (before.current !== null && before.current !== activeId) {
      void client.invalidateQueries({ queryKey: cameraKeys.calibration(before.current) });
      void client.invalidateQueries({ queryKey: cameraKeys.camera(camera.id) });
      void client.invalidateQueries({ queryKey: keys.cameras(camera.dataset.slug) });
    }
    before.current = activeId;
  }, [client, camera.id, camera.dataset.slug, activeId]);

  return { history, active, lost: active !== null && following.isError };
}

/** The calibration that the page shows: the one asked for, else the latest one that came to an end. */
export function useShownCalibration(asked: number | null, history: readonly CalibrationBrief[] | undefined) {
  const latest = history?.find(({ status }) => status === "done")?.id ?? null;
  const id = asked ?? latest;
  const query = useQuery({ ...calibrationQuery(id ?? 0), enabled: id !== null });
  return { id, query };
}
