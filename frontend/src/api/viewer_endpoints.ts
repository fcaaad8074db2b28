/** The API calls of the viewer: one scored image, its points, and what is sent to review. */

import { apiUrl, client, unwrap } from "./client";
import type { ScoredImageDetail } from "./viewer_types";

const IMAGE = "/api/submissions/{submission_id}/images/{split_image_id}";
const path = (submission_id: number, split_image_id: number) => ({ submission_id, split_image_id });

/** Which images one goes through, and in which order; nulls: all of them, by name. */
export interface ImageList {
  readonly sort: string | null;
  /** Part of their names. */
  readonly search: string | null;
}

export const ALL_BY_NAME: ImageList = { sort: null, search: null };

/** @param list What the neighbours are of. */
export const getScoredImage = (
  submission: number,
  image: number,
  { sort, search }: ImageList,
): Promise<ScoredImageDetail> =>
  unwrap(
    client.GET(IMAGE, {
      params: {
        path: path(submission, image),
        query: { ...(sort === null ? {} : { sort }), ...(search === null ? {} : { search }) },
      },
    }),
  );

export const getScoredPoints = (submission: number, image: number): Promise<ArrayBuffer> =>
  unwrap(
    client.GET(`${IMAGE}/points`, { params: { path: path(submission, image) }, parseAs: "arrayBuffer" }),
  );

export const overlayUrl = (submission: number, image: number) =>
  apiUrl(`/submissions/${submission}/images/${image}/overlay.png`);

/** Puts false positives among the undecided candidates of the dataset's image. */
export const sendToReview = (submission: number, image: number, predictions: number[]) =>
  unwrap(
    client.POST(`${IMAGE}/review`, { params: { path: path(submission, image) }, body: { predictions } }),
  );
