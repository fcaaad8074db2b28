import { useInfiniteQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { listScoredImages } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";

const PAGE = 200;

/** A submission's images in an order, page by page as they are needed. */
export function useScoredImages(id: number, sort: string, search: string) {
  const query = useInfiniteQuery({
    queryKey: boardKeys.scoredImages(id, sort, search),
    queryFn: ({ pageParam }) =>
      listScoredImages(id, { sort, search: search === "" ? null : search, cursor: pageParam, limit: PAGE }),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor,
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: (previous) => previous,
  });
  const items = useMemo(() => query.data?.pages.flatMap((page) => page.items) ?? [], [query.data]);
  return { query, items, total: query.data?.pages[0]?.total ?? 0 };
}
