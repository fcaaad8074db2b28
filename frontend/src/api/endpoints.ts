/** One function per API call the pages make. */

import { apiUrl, client, unwrap } from "./client";
import type { components, paths } from "./schema";
import type { ImageSegments, NewDecision, NewEdit, Recall, ReviewStatus, StageHistory, Trace } from "./types";

type Schemas = components["schemas"];
export type ImageFilter = Omit<
  NonNullable<paths["/api/datasets/{slug}/images"]["get"]["parameters"]["query"]>,
  "cursor" | "limit"
>;
export type RunRequest = Partial<Schemas["RunGiven"]>;
export type ImageChanges = Omit<Schemas["ImagesChange"], "ids">;

const dataset = (slug: string) => ({ path: { slug } });
const image = (image_id: number) => ({ path: { image_id } });
const run = (run_id: number) => ({ path: { run_id } });

export const getConfiguration = () => unwrap(client.GET("/api/configuration"));

export const listDatasets = (deleted = false) =>
  unwrap(client.GET("/api/datasets", { params: { query: { deleted } } }));
export const createDataset = (name: string) => unwrap(client.POST("/api/datasets", { body: { name } }));
export const getDataset = (slug: string) =>
  unwrap(client.GET("/api/datasets/{slug}", { params: dataset(slug) }));
export const getGuidelines = (slug: string) =>
  unwrap(client.GET("/api/datasets/{slug}/guidelines", { params: dataset(slug) }));
export const renameDataset = (slug: string, name: string) =>
  unwrap(client.PATCH("/api/datasets/{slug}", { params: dataset(slug), body: { name } }));
export const deleteDataset = (slug: string) =>
  unwrap(client.DELETE("/api/datasets/{slug}", { params: dataset(slug) }));
export const restoreDataset = (slug: string) =>
  unwrap(client.POST("/api/datasets/{slug}/restore", { params: dataset(slug) }));

export const listImages = (slug: string, filter: ImageFilter = {}, cursor?: string | null, limit = 100) =>
  unwrap(
    client.GET("/api/datasets/{slug}/images", {
      params: { ...dataset(slug), query: { ...filter, cursor: cursor ?? null, limit } },
    }),
  );
export const getFacets = (slug: string) =>
  unwrap(client.GET("/api/datasets/{slug}/facets", { params: dataset(slug) }));
export const updateImages = (slug: string, ids: number[], changes: ImageChanges) =>
  unwrap(client.PATCH("/api/datasets/{slug}/images", { params: dataset(slug), body: { ids, ...changes } }));
export const deleteImages = (slug: string, ids: number[]) =>
  unwrap(client.POST("/api/datasets/{slug}/images/delete", { params: dataset(slug), body: { ids } }));
export const restoreImages = (slug: string, ids: number[]) =>
  unwrap(client.POST("/api/datasets/{slug}/images/restore", { params: dataset(slug), body: { ids } }));

export const getImage = (id: number) => unwrap(client.GET("/api/images/{image_id}", { params: image(id) }));
// openapi-fetch widens the box's four numbers to an array of any length.
export const getSegments = (id: number) =>
  unwrap(client.GET("/api/images/{image_id}/segments", { params: image(id) })) as Promise<ImageSegments>;
export const getPoints = (id: number, view: "plain" | "undistorted" = "plain"): Promise<ArrayBuffer> =>
  unwrap(
    client.GET("/api/images/{image_id}/points", {
      // Left out where it is the usual one: the browser fetches that address ahead.
      params: { ...image(id), query: view === "plain" ? {} : { view } },
      parseAs: "arrayBuffer",
    }),
  );
export const getEvidence = (segment_id: number, signal?: AbortSignal) =>
  unwrap(
    client.GET("/api/segments/{segment_id}/evidence", {
      params: { path: { segment_id } },
      ...(signal === undefined ? {} : { signal }),
    }),
  );
export const getDecisions = (id: number) =>
  unwrap(client.GET("/api/images/{image_id}/decisions", { params: image(id) }));
export const getNeighbourVerdicts = (id: number) =>
  unwrap(client.GET("/api/images/{image_id}/neighbour_verdicts", { params: image(id) }));
export const getStageHistory = (segment_id: number, signal?: AbortSignal) =>
  unwrap(
    client.GET("/api/segments/{segment_id}/history", {
      params: { path: { segment_id } },
      ...(signal === undefined ? {} : { signal }),
    }),
  ) as Promise<StageHistory>;
export const getSuggestions = (id: number) =>
  unwrap(client.GET("/api/images/{image_id}/suggestions", { params: image(id) }));
export const getDatasetSuggestions = (slug: string) =>
  unwrap(client.GET("/api/datasets/{slug}/suggestions", { params: dataset(slug) }));
export const trainSuggestions = (slug: string) =>
  unwrap(client.POST("/api/datasets/{slug}/suggestions/train", { params: dataset(slug) }));
/** @param seen The image's last decision that is known here: later ones of others aren't overruled unseen. */
export const postDecisions = (id: number, decisions: NewDecision[], seen: number | null = null) =>
  unwrap(client.POST("/api/images/{image_id}/decisions", { params: image(id), body: { decisions, seen } }));
// openapi-fetch widens pairs of numbers to arrays of any length.
export const postTrace = (id: number, wanted: Partial<Schemas["TraceGiven"]>) =>
  unwrap(
    client.POST("/api/images/{image_id}/trace", {
      params: image(id),
      body: { reach: 8, straight: false, extend: false, ...wanted },
    }),
  ) as Promise<Trace>;
export const getEdits = (id: number) =>
  unwrap(client.GET("/api/images/{image_id}/edits", { params: image(id) }));
export const postEdit = (id: number, edit: NewEdit) =>
  unwrap(client.POST("/api/images/{image_id}/edits", { params: image(id), body: edit }));
export const putReview = (
  id: number,
  status: ReviewStatus,
  reason: string | null = null,
  recall: Recall | null = null,
) =>
  unwrap(
    client.PUT("/api/images/{image_id}/review", {
      params: image(id),
      body: { status, reason, allow_undecided: false, recall },
    }),
  );

export const startRun = (slug: string, request: RunRequest = {}) =>
  unwrap(
    client.POST("/api/datasets/{slug}/runs", {
      params: dataset(slug),
      body: { camera: "joint", discard: false, ...request },
    }),
  );
export const listRuns = (slug: string, deleted = false) =>
  unwrap(client.GET("/api/datasets/{slug}/runs", { params: { ...dataset(slug), query: { deleted } } }));
export const getRun = (id: number) => unwrap(client.GET("/api/runs/{run_id}", { params: run(id) }));
export const listRunImages = (id: number, status: "failed" | null = null, cursor: string | null = null) =>
  unwrap(client.GET("/api/runs/{run_id}/images", { params: { ...run(id), query: { status, cursor } } }));
export const retryRun = (id: number) => unwrap(client.POST("/api/runs/{run_id}/retry", { params: run(id) }));
export const cancelRun = (id: number) =>
  unwrap(client.POST("/api/runs/{run_id}/cancel", { params: run(id) }));
export const deleteRun = (id: number) => unwrap(client.DELETE("/api/runs/{run_id}", { params: run(id) }));
export const restoreRun = (id: number) =>
  unwrap(client.POST("/api/runs/{run_id}/restore", { params: run(id) }));

export const listCameras = (slug: string) =>
  unwrap(client.GET("/api/datasets/{slug}/cameras", { params: dataset(slug) }));

export const updateCamera = (id: number, changes: Schemas["CameraChange"]) =>
  unwrap(client.PATCH("/api/cameras/{camera_id}", { params: { path: { camera_id: id } }, body: changes }));

export const displayUrl = (imageId: number, view: "plain" | "clahe" | "undistorted" = "plain") =>
  apiUrl(`/images/${imageId}/display`, view === "plain" ? {} : { view });
export const thumbnailUrl = (imageId: number, size: 160 | 320 | 640) =>
  apiUrl(`/images/${imageId}/thumbnail`, { size });
export const exportUrl = (
  slug: string,
  options: { format?: string; allow_not_done?: boolean; images?: boolean } = {},
) => apiUrl(`/datasets/${encodeURIComponent(slug)}/export`, { format: "clearlines", ...options });
