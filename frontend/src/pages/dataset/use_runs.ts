import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef } from "react";
import { getRun, listRuns } from "../../api/endpoints";
import { keys } from "../../api/queries";
import type { Run } from "../../api/types";
import { isActive } from "../run_text";

const POLL_MS = 700;

/** A dataset's runs, newest first; the one under way is followed until it is over. */
export function useRuns(slug: string) {
  const client = useQueryClient();
  const runs = useQuery({ queryKey: keys.runs(slug), queryFn: () => listRuns(slug) });
  const active = runs.data?.find(isActive) ?? null;
  const activeId = active?.id ?? null;

  useQuery({
    queryKey: ["runs", activeId],
    enabled: activeId !== null,
    refetchInterval: POLL_MS,
    queryFn: async () => {
      const run = await getRun(activeId ?? 0);
      client.setQueryData<Run[]>(keys.runs(slug), (old) =>
        old?.map((other) => (other.id === run.id ? run : other)),
      );
      return run;
    },
  });

  // Counts, facets, images and lenses are other ones once a run is over.
  const before = useRef(activeId);
  useEffect(() => {
    if (before.current !== null && before.current !== activeId) {
      void client.invalidateQueries({ queryKey: keys.dataset(slug) });
    }
    before.current = activeId;
  }, [client, slug, activeId]);

  return { runs, active };
}
