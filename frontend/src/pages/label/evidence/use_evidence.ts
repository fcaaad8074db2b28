import { useQuery } from "@tanstack/react-query";
import { getEvidence } from "../../../api/endpoints";
import { evidenceQuery } from "../../../api/queries";
import type { Evidence } from "../../../api/types";
import { useSettled } from "../../../design/use_settled";
import { firstPaint } from "../../../image_view/first_paint";

/** Whoever goes through candidates with Tab doesn't want each one measured (ms). */
const PAUSE = 120;

/** What speaks for a candidate; null while it is measured, and while the person goes from one to the next. */
export function useEvidence(
  imageId: number,
  segmentId: number,
): { evidence: Evidence | null; error: unknown } {
  const settled = useSettled<number | null>(segmentId, null, PAUSE);
  const { data, error } = useQuery({
    ...evidenceQuery(imageId, segmentId),
    queryFn: ({ signal }) => firstPaint.whenPainted(imageId).then(() => getEvidence(segmentId, signal)),
    enabled: settled === segmentId,
  });
  return { evidence: data ?? null, error };
}
