/** Calls and queries of cameras and their calibrations. */

import { queryOptions } from "@tanstack/react-query";
import type {
  CalibrationDetail,
  CalibrationLinePage,
  CalibrationSource,
  ExportOverview,
  ImageLines,
  LensFamily,
  LineOrder,
} from "./camera_types";
import { apiUrl, client, unwrap } from "./client";
import type { Camera } from "./types";
import { sendForm } from "./upload";

/** A focal length and principal point that a person gives, px; what is null is estimated or nominal. */
export interface GivenIntrinsics {
  readonly focal_length: number | null;
  readonly cx: number | null;
  readonly cy: number | null;
}

export const cameraKeys = {
  /** Everything of one camera. */
  camera: (id: number) => ["cameras", id] as const,
  calibrations: (cameraId: number) => ["cameras", cameraId, "calibrations"] as const,
  /** Everything of one calibration. */
  calibration: (id: number) => ["calibrations", id] as const,
  lines: (id: number, order: LineOrder) => ["calibrations", id, "lines", order] as const,
  difference: (id: number) => ["calibrations", id, "difference"] as const,
};

const camera = (camera_id: number) => ({ path: { camera_id } });
const calibration = (calibration_id: number) => ({ path: { calibration_id } });

/** What a finished calibration says never changes. */
const FOR_EVER = { staleTime: Number.POSITIVE_INFINITY } as const;
/** A camera has few calibrations: the first page holds them. */
const HISTORY = 200;

export const cameraQuery = (id: number) =>
  queryOptions({
    queryKey: cameraKeys.camera(id),
    queryFn: () => unwrap(client.GET("/api/cameras/{camera_id}", { params: camera(id) })),
  });

export const calibrationsQuery = (cameraId: number) =>
  queryOptions({
    queryKey: cameraKeys.calibrations(cameraId),
    queryFn: async () => {
      const page = await unwrap(
        client.GET("/api/cameras/{camera_id}/calibrations", {
          params: { ...camera(cameraId), query: { limit: HISTORY } },
        }),
      );
      return page.items;
    },
  });

/** Those that can still be restored. */
export const deletedCalibrationsQuery = (cameraId: number) =>
  queryOptions({
    queryKey: [...cameraKeys.calibrations(cameraId), "deleted"],
    queryFn: async () => {
      const page = await unwrap(
        client.GET("/api/cameras/{camera_id}/calibrations", {
          params: { ...camera(cameraId), query: { deleted: true } },
        }),
      );
      return page.items;
    },
  });

// openapi-fetch widens pairs of numbers to arrays of any length, here and below.
export const getCalibration = (id: number) =>
  unwrap(
    client.GET("/api/calibrations/{calibration_id}", { params: calibration(id) }),
  ) as Promise<CalibrationDetail>;

export const calibrationQuery = (id: number) =>
  queryOptions({ queryKey: cameraKeys.calibration(id), queryFn: () => getCalibration(id) });

export const startCalibration = (cameraId: number, source: CalibrationSource, family: LensFamily | null) =>
  unwrap(
    client.POST("/api/cameras/{camera_id}/calibrations", {
      params: camera(cameraId),
      body: { source, family },
    }),
  );
export const cancelCalibration = (id: number) =>
  unwrap(client.POST("/api/calibrations/{calibration_id}/cancel", { params: calibration(id) }));
export const deleteCalibration = (id: number) =>
  unwrap(client.DELETE("/api/calibrations/{calibration_id}", { params: calibration(id) }));
export const restoreCalibration = (id: number) =>
  unwrap(client.POST("/api/calibrations/{calibration_id}/restore", { params: calibration(id) }));

export const listCalibrationLines = (id: number, order: LineOrder, cursor: string | null, limit: number) =>
  unwrap(
    client.GET("/api/calibrations/{calibration_id}/lines", {
      params: { ...calibration(id), query: { order, cursor, limit } },
    }),
  ) as Promise<CalibrationLinePage>;

export const calibrationImagesQuery = (id: number) =>
  queryOptions({
    queryKey: [...cameraKeys.calibration(id), "images"],
    queryFn: () =>
      unwrap(client.GET("/api/calibrations/{calibration_id}/images", { params: calibration(id) })),
  });

export const imageLinesQuery = (id: number, imageId: number) =>
  queryOptions({
    queryKey: [...cameraKeys.calibration(id), "images", imageId, "lines"],
    queryFn: () =>
      unwrap(
        client.GET("/api/calibrations/{calibration_id}/images/{image_id}/lines", {
          params: { path: { calibration_id: id, image_id: imageId } },
        }),
      ) as Promise<ImageLines>,
    ...FOR_EVER,
  });

export const adviceQuery = (id: number) =>
  queryOptions({
    queryKey: [...cameraKeys.calibration(id), "advice"],
    queryFn: () =>
      unwrap(client.GET("/api/calibrations/{calibration_id}/advice", { params: calibration(id) })),
  });

export const differenceQuery = (id: number) =>
  queryOptions({
    queryKey: cameraKeys.difference(id),
    queryFn: () =>
      unwrap(client.GET("/api/calibrations/{calibration_id}/difference", { params: calibration(id) })),
  });

export const exportsQuery = (id: number, given: GivenIntrinsics) =>
  queryOptions({
    queryKey: [...cameraKeys.calibration(id), "exports", given],
    queryFn: () =>
      unwrap(
        client.GET("/api/calibrations/{calibration_id}/exports", {
          params: { ...calibration(id), query: { ...given } },
        }),
      ) as Promise<ExportOverview>,
    ...FOR_EVER,
  });

/** Sets a camera's reference from another tool's file. */
export function sendReference(cameraId: number, file: File, signal: AbortSignal): Promise<Camera> {
  const form = new FormData();
  form.append("file", file, file.name);
  return sendForm(`/cameras/${cameraId}/reference-file`, form, { signal, onProgress: () => undefined });
}

export const undistortedUrl = (id: number, imageId: number) =>
  apiUrl(`/calibrations/${id}/images/${imageId}/undistorted`);
export const calibrationExportUrl = (id: number, format: string, given: GivenIntrinsics) =>
  apiUrl(`/calibrations/${id}/exports/${format}`, { ...given });
export const reportUrl = (id: number) => apiUrl(`/calibrations/${id}/report`);
