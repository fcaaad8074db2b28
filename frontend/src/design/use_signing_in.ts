import { useQueryClient } from "@tanstack/react-query";
import { useCallback } from "react";

/** Does what signs in or out, and forgets all that was fetched before: somebody else sees other things. */
export function useSigningIn(): (act: () => Promise<unknown>) => Promise<void> {
  const client = useQueryClient();
  return useCallback(
    async (act) => {
      await act();
      await client.resetQueries();
    },
    [client],
  );
}
