/** Calls and queries of what a dataset's people share: tasks, guidelines, second reviews, statistics. */

import { queryOptions } from "@tanstack/react-query";
import { client, unwrap } from "./client";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Statistics = Schemas["StatisticsAnswer"];
export type DecisionTimes = Schemas["DecisionTimes"];
export type Person = Schemas["PersonAnswer"];
export type Agreement = Schemas["AgreementAnswer"];
export type Kappa = Schemas["KappaAnswer"];
export type SecondReviews = Schemas["SecondReviewsAnswer"];
export type SecondReview = Schemas["SecondReviewAnswer"];
export type Guidelines = Schemas["GuidelinesAnswer"];
export type Rules = Schemas["Rules"];

const dataset = (slug: string) => ({ path: { slug } });

export const teamKeys = {
  people: (slug: string) => ["datasets", slug, "people"] as const,
  statistics: (slug: string) => ["datasets", slug, "statistics"] as const,
  agreement: (slug: string) => ["datasets", slug, "agreement"] as const,
  secondReviews: (slug: string) => ["datasets", slug, "second-reviews"] as const,
};

export const peopleQuery = (slug: string) =>
  queryOptions({
    queryKey: teamKeys.people(slug),
    queryFn: () => unwrap(client.GET("/api/datasets/{slug}/people", { params: dataset(slug) })),
  });

export const statisticsQuery = (slug: string) =>
  queryOptions({
    queryKey: teamKeys.statistics(slug),
    queryFn: () => unwrap(client.GET("/api/datasets/{slug}/statistics", { params: dataset(slug) })),
  });

export const agreementQuery = (slug: string) =>
  queryOptions({
    queryKey: teamKeys.agreement(slug),
    queryFn: () => unwrap(client.GET("/api/datasets/{slug}/agreement", { params: dataset(slug) })),
  });

export const secondReviewsQuery = (slug: string) =>
  queryOptions({
    queryKey: teamKeys.secondReviews(slug),
    queryFn: () => unwrap(client.GET("/api/datasets/{slug}/second-reviews", { params: dataset(slug) })),
  });

export const assignImages = (slug: string, body: Schemas["AssignGiven"]) =>
  unwrap(client.POST("/api/datasets/{slug}/assign", { params: dataset(slug), body }));

export const changeGuidelines = (slug: string, changes: { guidelines?: string | null; rules?: Rules }) =>
  unwrap(client.PATCH("/api/datasets/{slug}", { params: dataset(slug), body: changes }));

export const beginSecondReview = (image_id: number) =>
  unwrap(client.POST("/api/images/{image_id}/second-review", { params: { path: { image_id } } }));

/** A candidate on which first and second review differ; openapi-typescript widens its box to any length. */
export type Difference = Omit<Schemas["Difference"], "box"> & { box: [number, number, number, number] };

/** So many are fetched at a time; a page of differences shows them all. */
const DIFFERENCES = 500;

export const differencesQuery = (slug: string) =>
  queryOptions({
    queryKey: ["datasets", slug, "differences"],
    queryFn: async () => {
      const all: Difference[] = [];
      let cursor: string | null = null;
      do {
        const page: { items: unknown[]; next_cursor: string | null } = await unwrap(
          client.GET("/api/datasets/{slug}/differences", {
            params: { ...dataset(slug), query: { limit: DIFFERENCES, cursor } },
          }),
        );
        all.push(...(page.items as Difference[]));
        cursor = page.next_cursor;
      } while (cursor !== null);
      return all;
    },
    // What is decided here is taken in by hand: fetching again would lose one's place.
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 0,
    refetchOnWindowFocus: false,
  });

export const adjudicate = (
  { second_review_id, segment_id }: Difference,
  verdict: Schemas["AdjudicationGiven"]["verdict"],
  client_id: string,
) =>
  unwrap(
    client.POST("/api/second-reviews/{second_review_id}/adjudications", {
      params: { path: { second_review_id } },
      body: { segment_id, verdict, client_id },
    }),
  ) as Promise<Difference>;

export const takeAdjudicationBack = ({ second_review_id, segment_id }: Difference) =>
  unwrap(
    client.DELETE("/api/second-reviews/{second_review_id}/adjudications/{segment_id}", {
      params: { path: { second_review_id, segment_id } },
    }),
  ) as Promise<Difference>;

export type SecondSegments = Schemas["SecondSegmentsAnswer"];
export type NewSecondDecision = Schemas["SecondDecisionGiven"];
export type SecondDecision = Schemas["SecondDecisionAnswer"];

const second = (second_review_id: number) => ({ path: { second_review_id } });

export const getSecondSegments = (id: number) =>
  unwrap(
    client.GET("/api/second-reviews/{second_review_id}/segments", { params: second(id) }),
  ) as Promise<SecondSegments>;
export const getSecondDecisions = (id: number) =>
  unwrap(client.GET("/api/second-reviews/{second_review_id}/decisions", { params: second(id) }));
export const postSecondDecisions = (id: number, decisions: NewSecondDecision[]) =>
  unwrap(
    client.POST("/api/second-reviews/{second_review_id}/decisions", {
      params: second(id),
      body: { decisions },
    }),
  );
export const putSecondReview = (id: number, status: "open" | "done") =>
  unwrap(
    client.PUT("/api/second-reviews/{second_review_id}/review", {
      params: second(id),
      body: { status, allow_undecided: false },
    }),
  );
