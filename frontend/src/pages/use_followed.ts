import { type QueryKey, useQueryClient } from "@tanstack/react-query";
import { useCallback } from "react";
import { failed } from "./datasets/use_dataset_actions";

/** Does something, and has what was fetched under a key follow it; a failure is told in a note. */
export function useFollowed(queryKey: QueryKey): (act: () => Promise<unknown>) => Promise<void> {
  const client = useQueryClient();
  return useCallback(
    async (act) => {
      try {
        await act();
        await client.invalidateQueries({ queryKey });
      } catch (error) {
        failed(error);
      }
    },
    [client, queryKey],
  );
}
