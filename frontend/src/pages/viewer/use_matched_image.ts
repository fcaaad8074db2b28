/** A scored image with its points, and what comes next fetched ahead. */

import { type QueryClient, queryOptions, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { ALL_BY_NAME, getScoredImage, getScoredPoints, type ImageList } from "../../api/viewer_endpoints";
import { decodePolylines } from "../../canvas/decode";
import { imageLoader } from "../../image_view/use_image_bitmap";
import { type MatchedImage, makeMatchedImage } from "./matched_image";

export const matchedImageQuery = (submission: number, image: number, list: ImageList) =>
  queryOptions({
    queryKey: ["submissions", submission, "scored-image", image, list],
    queryFn: async (): Promise<MatchedImage> => {
      const [detail, points] = await Promise.all([
        getScoredImage(submission, image, list),
        getScoredPoints(submission, image),
      ]);
      return makeMatchedImage(detail, decodePolylines(points));
    },
    // A score never changes; a new one comes with a new page.
    staleTime: Number.POSITIVE_INFINITY,
  });

/** @param enabled Whether the image may be asked for at all. */
export function useMatchedImage(submission: number | null, image: number, list: ImageList, enabled: boolean) {
  return useQuery({
    ...matchedImageQuery(submission ?? 0, image, list),
    enabled: enabled && submission !== null,
  });
}

/** Fetches the neighbours once the image itself is there: they must not have to share the server. */
export function usePrefetchedNeighbours(
  submission: number,
  other: number | null,
  image: MatchedImage | undefined,
  { sort, search }: ImageList,
): void {
  const queryClient = useQueryClient();
  useEffect(() => {
    if (image === undefined) return;
    let current = true;
    const run = async () => {
      await imageLoader.load(image.detail.display).catch(() => undefined);
      for (const neighbour of [image.detail.next, image.detail.previous]) {
        if (current && neighbour !== null)
          await prefetch(queryClient, submission, neighbour, { sort, search });
        if (current && neighbour !== null && other !== null)
          await prefetch(queryClient, other, neighbour, ALL_BY_NAME);
      }
    };
    run();
    return () => {
      current = false;
    };
  }, [queryClient, submission, other, image, sort, search]);
}

async function prefetch(
  queryClient: QueryClient,
  submission: number,
  image: number,
  list: ImageList,
): Promise<void> {
  const found = await queryClient.fetchQuery(matchedImageQuery(submission, image, list)).catch(() => null);
  if (found !== null) await imageLoader.prefetch(found.detail.display, found.detail);
}
