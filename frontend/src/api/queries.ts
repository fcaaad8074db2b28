/** Query keys in one place, so that a change can tell exactly which answers are out of date. */

import { QueryCache, QueryClient, queryOptions } from "@tanstack/react-query";
import { boardKeys } from "./board_queries";
import * as api from "./endpoints";
import { RequestFailed } from "./problem";

export const keys = {
  configuration: ["configuration"] as const,
  datasets: ["datasets"] as const,
  dataset: (slug: string) => ["datasets", slug] as const,
  images: (slug: string) => ["datasets", slug, "images"] as const,
  facets: (slug: string) => ["datasets", slug, "facets"] as const,
  guidelines: (slug: string) => ["datasets", slug, "guidelines"] as const,
  runs: (slug: string) => ["datasets", slug, "runs"] as const,
  cameras: (slug: string) => ["datasets", slug, "cameras"] as const,
  image: (id: number) => ["images", id] as const,
  evidence: (imageId: number, segmentId: number) => ["images", imageId, "evidence", segmentId] as const,
  suggestions: (imageId: number) => ["images", imageId, "suggestions"] as const,
  datasetSuggestions: (slug: string) => ["datasets", slug, "suggestions"] as const,
  stages: (imageId: number, segmentId: number) => ["images", imageId, "stages", segmentId] as const,
};

export const configurationQuery = queryOptions({
  queryKey: keys.configuration,
  queryFn: api.getConfiguration,
  staleTime: Number.POSITIVE_INFINITY,
});

export const datasetQuery = (slug: string) =>
  queryOptions({ queryKey: keys.dataset(slug), queryFn: () => api.getDataset(slug) });

export const guidelinesQuery = (slug: string) =>
  queryOptions({ queryKey: keys.guidelines(slug), queryFn: () => api.getGuidelines(slug) });

export const imageQuery = (id: number) =>
  queryOptions({ queryKey: keys.image(id), queryFn: () => api.getImage(id) });

export const evidenceQuery = (imageId: number, segmentId: number) =>
  queryOptions({
    queryKey: keys.evidence(imageId, segmentId),
    queryFn: ({ signal }) => api.getEvidence(segmentId, signal),
    staleTime: Number.POSITIVE_INFINITY,
  });

/** Stays as it is while the image is open: a model that is learnt meanwhile changes nothing under one's hands. */
export const suggestionsQuery = (id: number) =>
  queryOptions({
    queryKey: keys.suggestions(id),
    queryFn: () => api.getSuggestions(id),
    staleTime: Number.POSITIVE_INFINITY,
  });

export const datasetSuggestionsQuery = (slug: string) =>
  queryOptions({ queryKey: keys.datasetSuggestions(slug), queryFn: () => api.getDatasetSuggestions(slug) });

export const stagesQuery = (imageId: number, segmentId: number) =>
  queryOptions({
    queryKey: keys.stages(imageId, segmentId),
    queryFn: ({ signal }) => api.getStageHistory(segmentId, signal),
    staleTime: Number.POSITIVE_INFINITY,
  });

/** Whether the token that went along is no longer good; the server has the browser forget it. */
function isSignedOut(error: unknown): boolean {
  return error instanceof RequestFailed && error.problem.status === 401;
}

export function makeQueryClient(): QueryClient {
  const client: QueryClient = new QueryClient({
    queryCache: new QueryCache({
      onError: (error, query) => {
        if (isSignedOut(error) && query.queryKey[0] !== boardKeys.me[0]) {
          void client.invalidateQueries({ queryKey: boardKeys.me });
        }
      },
    }),
    defaultOptions: {
      queries: {
        staleTime: 2_000,
        retry: (failures, error) =>
          (error instanceof RequestFailed && error.temporary && failures < 2) ||
          (isSignedOut(error) && failures < 1),
      },
      mutations: { retry: false },
    },
  });
  return client;
}
