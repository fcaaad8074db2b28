/** Query keys and options of splits, boards, submissions and methods. */

import { queryOptions } from "@tanstack/react-query";
import * as api from "./board_endpoints";

export const boardKeys = {
  me: ["me"] as const,
  splits: ["splits"] as const,
  split: (slug: string) => ["splits", slug] as const,
  board: (slug: string, version: number | null) => ["splits", slug, "board", version] as const,
  ownSubmissions: (slug: string) => ["splits", slug, "submissions", "mine"] as const,
  submission: (id: number) => ["submissions", id] as const,
  scoredImages: (id: number, sort: string, search: string) =>
    ["submissions", id, "images", sort, search] as const,
  comparison: (id: number, other: number) => ["submissions", id, "comparison", other] as const,
  method: (slug: string) => ["methods", slug] as const,
  card: (slug: string) => ["datasets", slug, "card"] as const,
};

export const meQuery = queryOptions({ queryKey: boardKeys.me, queryFn: api.getMe, staleTime: 60_000 });

export const splitsQuery = queryOptions({ queryKey: boardKeys.splits, queryFn: api.listSplits });

export const splitQuery = (slug: string) =>
  queryOptions({ queryKey: boardKeys.split(slug), queryFn: () => api.getSplit(slug) });

export const boardQuery = (slug: string, version: number | null) =>
  queryOptions({ queryKey: boardKeys.board(slug, version), queryFn: () => api.getBoard(slug, version) });

export const submissionQuery = (id: number) =>
  queryOptions({ queryKey: boardKeys.submission(id), queryFn: () => api.getSubmission(id) });

export const methodQuery = (slug: string) =>
  queryOptions({ queryKey: boardKeys.method(slug), queryFn: () => api.getMethod(slug) });

export const cardQuery = (slug: string) =>
  queryOptions({ queryKey: boardKeys.card(slug), queryFn: () => api.getCard(slug) });

export const comparisonQuery = (id: number, other: number) =>
  queryOptions({
    queryKey: boardKeys.comparison(id, other),
    queryFn: () => api.compareSubmissions(id, other),
  });
