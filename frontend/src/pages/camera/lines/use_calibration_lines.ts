import { useInfiniteQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { cameraKeys, listCalibrationLines } from "../../../api/camera_endpoints";
import type { LineOrder } from "../../../api/camera_types";

/** Enough for most cameras at once, so that the histogram has all of them. */
const PAGE = 500;

/** The lines of a calibration in an order, page by page as they are needed. */
export function useCalibrationLines(id: number, order: LineOrder) {
  const query = useInfiniteQuery({
    queryKey: cameraKeys.lines(id, order),
    queryFn: ({ pageParam }) => listCalibrationLines(id, order, pageParam, PAGE),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor,
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: (previous) => previous,
  });
  const items = useMemo(() => query.data?.pages.flatMap((page) => page.items) ?? [], [query.data]);
  return { query, items, total: query.data?.pages[0]?.total ?? 0 };
}
