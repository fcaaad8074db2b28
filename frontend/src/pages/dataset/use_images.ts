import { type InfiniteData, useInfiniteQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useMemo } from "react";
import { type ImageFilter, listImages } from "../../api/endpoints";
import { keys } from "../../api/queries";
import type { ImagePage, ImageSummary } from "../../api/types";

const PAGE = 200;
/** The server takes at most this many at once. */
const LARGEST_PAGE = 500;

type Pages = InfiniteData<ImagePage, string | null>;

/** The images of a view, loaded page by page as they are needed. */
export function useImages(slug: string, filter: ImageFilter) {
  const client = useQueryClient();
  const key = useMemo(() => [...keys.images(slug), "pages", filter] as const, [slug, filter]);
  const query = useInfiniteQuery({
    queryKey: key,
    queryFn: ({ pageParam }) => listImages(slug, filter, pageParam, PAGE),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor,
    staleTime: Number.POSITIVE_INFINITY,
    refetchOnWindowFocus: false,
  });
  const { data, fetchNextPage } = query;
  const items = useMemo(() => data?.pages.flatMap((page) => page.items) ?? [], [data]);
  const { total, exact } = countOf(data?.pages.at(-1), items.length);

  /** Asks again for the pages that hold these places alone: a run changes images all over a long list. */
  const refresh = useCallback(
    async (first: number, end: number) => {
      const pages = client.getQueryData<Pages>(key);
      if (!pages) return;
      let start = 0;
      const touched = pages.pages.flatMap((page, index) => {
        const place = start;
        start += page.items.length;
        return place < end && start > first ? [index] : [];
      });
      await Promise.all(
        touched.map(async (index) => {
          const page = await listImages(slug, filter, pages.pageParams[index] ?? null, PAGE);
          client.setQueryData<Pages>(key, (old) => old && withPage(old, index, page));
        }),
      );
    },
    [client, key, slug, filter],
  );

  const loadAll = useCallback(async (): Promise<ImageSummary[]> => {
    let result = await fetchNextPage({ cancelRefetch: false });
    while (result.hasNextPage && !result.isError) result = await fetchNextPage({ cancelRefetch: false });
    if (result.isError) throw result.error;
    return result.data?.pages.flatMap((page) => page.items) ?? [];
  }, [fetchNextPage]);

  return { query, items, total, exact, refresh, loadAll };
}

/** How many images there are, as far as that is known; one more than are loaded has the next page asked for. */
export function countOf(
  last: Pick<ImagePage, "total" | "total_exact" | "next_cursor"> | undefined,
  loaded: number,
): { total: number; exact: boolean } {
  if (!last) return { total: 0, exact: true };
  if (last.total_exact) return { total: last.total, exact: true };
  if (last.next_cursor === null) return { total: loaded, exact: true };
  return { total: Math.max(last.total, loaded + 1), exact: false };
}

/** The ids of all images that a filter lets through. */
export async function imageIds(slug: string, filter: ImageFilter): Promise<number[]> {
  const ids: number[] = [];
  let cursor: string | null = null;
  do {
    const page: ImagePage = await listImages(slug, filter, cursor, LARGEST_PAGE);
    ids.push(...page.items.map((image) => image.id));
    cursor = page.next_cursor;
  } while (cursor !== null);
  return ids;
}

function withPage(pages: Pages, index: number, page: ImagePage): Pages {
  // Where the list has changed its cuts, the pages after this one would repeat or miss images.
  if (pages.pages[index]?.next_cursor !== page.next_cursor) {
    const kept = [...pages.pages.slice(0, index), page];
    return { pages: kept, pageParams: pages.pageParams.slice(0, index + 1) };
  }
  return { ...pages, pages: pages.pages.with(index, page) };
}
