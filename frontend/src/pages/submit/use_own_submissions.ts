import { useInfiniteQuery } from "@tanstack/react-query";
import { listSubmissions } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import { isFinal } from "../../api/follow_submission";

const POLL_MS = 2_000;

/** One's own submissions to a split, newest first, page by page; asked for again while one goes on. */
export function useOwnSubmissions(split: string) {
  return useInfiniteQuery({
    queryKey: boardKeys.ownSubmissions(split),
    queryFn: ({ pageParam }) => listSubmissions(split, { mine: true, cursor: pageParam }),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor,
    refetchInterval: (query) =>
      query.state.data?.pages.some(({ items }) => items.some((item) => !isFinal(item))) ? POLL_MS : false,
  });
}

/** Names of the methods that one has submitted here before. */
export function useOwnMethods(split: string): string[] {
  const { data } = useOwnSubmissions(split);
  const names = data?.pages.flatMap(({ items }) => items.map(({ method }) => method.name)) ?? [];
  return [...new Set(names)];
}
