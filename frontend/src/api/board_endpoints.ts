/** One function per API call about splits, submissions, methods and who is signed in. */

import type {
  MethodChanges,
  NewSplit,
  SplitChanges,
  Submission,
  SubmissionChanges,
  Validation,
} from "./board_types";
import { apiUrl, client, unwrap } from "./client";
import type { paths } from "./schema";
import { type SendOptions, sendForm } from "./upload";

const split = (slug: string) => ({ path: { split: slug } });
const dataset = (slug: string) => ({ path: { slug } });
const submission = (submission_id: number) => ({ path: { submission_id } });
const method = (slug: string) => ({ path: { method: slug } });
const splitPath = (slug: string) => `/splits/${encodeURIComponent(slug)}`;

export const getMe = () => unwrap(client.GET("/api/me"));
export const signIn = (token: string) => unwrap(client.POST("/api/session", { body: { token } }));
export const signOut = () => unwrap(client.DELETE("/api/session"));

export const listSplits = () => unwrap(client.GET("/api/splits"));
export const getSplit = (slug: string) => unwrap(client.GET("/api/splits/{split}", { params: split(slug) }));
export const freezeSplit = (datasetSlug: string, given: NewSplit) =>
  unwrap(
    client.POST("/api/datasets/{slug}/splits", {
      params: dataset(datasetSlug),
      body: { min_length: 0, visibility: "open", ...given },
    }),
  );
export const changeSplit = (slug: string, changes: SplitChanges) =>
  unwrap(client.PATCH("/api/splits/{split}", { params: split(slug), body: changes }));
export const freezeAgain = (slug: string) =>
  unwrap(client.POST("/api/splits/{split}/versions", { params: split(slug), body: {} }));
export const deleteSplit = (slug: string) =>
  unwrap(client.DELETE("/api/splits/{split}", { params: split(slug) }));
export const restoreSplit = (slug: string) =>
  unwrap(client.POST("/api/splits/{split}/restore", { params: split(slug) }));

export const getBoard = (slug: string, version: number | null) =>
  unwrap(client.GET("/api/splits/{split}/board", { params: { ...split(slug), query: { version } } }));
export const boardUrl = (slug: string, version: number | null) =>
  apiUrl(`${splitPath(slug)}/board`, { version });
export const boardCsvUrl = (slug: string, version: number | null) =>
  apiUrl(`${splitPath(slug)}/board.csv`, { version });
export const truthUrl = (slug: string, version: number | null, format: "npz" | "json") =>
  apiUrl(`${splitPath(slug)}/truth`, { version, format });

export const splitImagesUrl = (slug: string) => apiUrl(`${splitPath(slug)}/images`, { limit: 500 });

export const validateSubmission = (slug: string, form: FormData, options: SendOptions) =>
  sendForm<Validation>(`${splitPath(slug)}/submissions/validate`, form, options);
export const postSubmission = (slug: string, form: FormData, options: SendOptions) =>
  sendForm<Submission>(`${splitPath(slug)}/submissions`, form, options);

export type SubmissionQuery = NonNullable<
  paths["/api/splits/{split}/submissions"]["get"]["parameters"]["query"]
>;
export const listSubmissions = (slug: string, query: SubmissionQuery = {}) =>
  unwrap(client.GET("/api/splits/{split}/submissions", { params: { ...split(slug), query } }));
export const getSubmission = (id: number) =>
  unwrap(client.GET("/api/submissions/{submission_id}", { params: submission(id) }));
export const submissionEventsUrl = (id: number) => apiUrl(`/submissions/${id}/events`);
export const changeSubmission = (id: number, changes: SubmissionChanges) =>
  unwrap(client.PATCH("/api/submissions/{submission_id}", { params: submission(id), body: changes }));
export const withdrawSubmission = (id: number) =>
  unwrap(client.POST("/api/submissions/{submission_id}/withdraw", { params: submission(id) }));
export const restoreSubmission = (id: number) =>
  unwrap(client.POST("/api/submissions/{submission_id}/restore", { params: submission(id) }));
export const rescoreSubmission = (id: number) =>
  unwrap(client.POST("/api/submissions/{submission_id}/rescore", { params: submission(id) }));
export const submissionFileUrl = (id: number, form: "npz" | "upload") =>
  apiUrl(`/submissions/${id}/file`, { form });
export const submissionMatchesUrl = (id: number) => apiUrl(`/submissions/${id}/matches`);

export type ScoredImageQuery = NonNullable<
  paths["/api/submissions/{submission_id}/images"]["get"]["parameters"]["query"]
>;
export const listScoredImages = (id: number, query: ScoredImageQuery) =>
  unwrap(client.GET("/api/submissions/{submission_id}/images", { params: { ...submission(id), query } }));
export const compareSubmissions = (id: number, other: number) =>
  unwrap(
    client.GET("/api/submissions/{submission_id}/compare/{other}", {
      params: { path: { submission_id: id, other } },
    }),
  );

export const getMethod = (slug: string) =>
  unwrap(client.GET("/api/methods/{method}", { params: method(slug) }));
export const changeMethod = (slug: string, changes: MethodChanges) =>
  unwrap(client.PATCH("/api/methods/{method}", { params: method(slug), body: changes }));

export const getCard = (datasetSlug: string) =>
  unwrap(client.GET("/api/datasets/{slug}/card", { params: dataset(datasetSlug) }));
export const changeCard = (
  datasetSlug: string,
  changes: { description: string | null; licence: string | null; citation: string | null },
) => unwrap(client.PATCH("/api/datasets/{slug}", { params: dataset(datasetSlug), body: changes }));
