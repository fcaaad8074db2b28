import { useQuery } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { evidenceQuery } from "../../../api/queries";
import type { Evidence } from "../../../api/types";

/** Whoever goes through candidates with Tab doesn't want each one measured (ms). */
const PAUSE = 120;

/** What speaks for a candidate; null while it is measured, and while the person goes from one to the next. */
export function useEvidence(
  imageId: number,
  segmentId: number,
): { evidence: Evidence | null; error: unknown } {
  const settled = useSettled(segmentId);
  const { data, error } = useQuery({
    ...evidenceQuery(imageId, segmentId),
    enabled: settled === segmentId,
  });
  return { evidence: data ?? null, error };
}

function useSettled(segmentId: number): number | null {
  const [settled, setSettled] = useState<number | null>(null);
  useEffect(() => {
    const timer = setTimeout(() => setSettled(segmentId), PAUSE);
    return () => clearTimeout(timer);
  }, [segmentId]);
  return settled;
}
