/** A scored image with its points, and what comes next fetched ahead. */

import { type QueryClient, queryOptions, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { getScoredImage, getScoredPoints } from "../../api/viewer_endpoints";
import { decodePolylines } from "../../canvas/decode";
import { imageLoader } from "../../image_view/use_image_bitmap";
import { type MatchedImage, makeMatchedImage } from "./matched_image";

export const matchedImageQuery = (submission: number, image: number, sort: string | null) =>
  queryOptions({
    queryKey: ["submissions", submission, "scored-image", image, sort],
    queryFn: async (): Promise<MatchedImage> => {
      const [detail, points] = await Promise.all([
        getScoredImage(submission, image, sort),
        getScoredPoints(submission, image),
      ]);
      return makeMatchedImage(detail, decodePolylines(points));
    },
    // A score never changes; a new one comes with a new page.
    staleTime: Number.POSITIVE_INFINITY,
  });

/** @param enabled Whether the image may be asked for at all. */
export function useMatchedImage(
  submission: number | null,
  image: number,
  sort: string | null,
  enabled: boolean,
) {
  return useQuery({
    ...matchedImageQuery(submission ?? 0, image, sort),
    enabled: enabled && submission !== null,
  });
}

/** Fetches the neighbours once the image itself is there: they must not have to share the server. */
export function usePrefetchedNeighbours(
  submissions: readonly number[],
  image: MatchedImage | undefined,
  sort: string | null,
): void {
  const queryClient = useQueryClient();
  const wanted = submissions.join();
  useEffect(() => {
    if (image === undefined) return;
    let current = true;
    const run = async () => {
      await imageLoader.load(image.detail.display).catch(() => undefined);
      for (const neighbour of [image.detail.next, image.detail.previous]) {
        for (const submission of wanted.split(",").map(Number)) {
          if (current && neighbour !== null) await prefetch(queryClient, submission, neighbour, sort);
        }
      }
    };
    run();
    return () => {
      current = false;
    };
  }, [queryClient, wanted, image, sort]);
}

async function prefetch(
  queryClient: QueryClient,
  submission: number,
  image: number,
  sort: string | null,
): Promise<void> {
  const found = await queryClient.fetchQuery(matchedImageQuery(submission, image, sort)).catch(() => null);
  if (found !== null) await imageLoader.prefetch(found.detail.display, found.detail);
}
