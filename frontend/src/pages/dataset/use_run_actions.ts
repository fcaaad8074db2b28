import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { cancelRun, deleteRun, restoreRun, retryRun } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { formatQuantity } from "../../design/format";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

/** What can be done with a run; the lists follow, a failure is shown. */
export function useRunActions(slug: string) {
  const client = useQueryClient();
  return useMemo(() => {
    const refresh = () => client.invalidateQueries({ queryKey: keys.dataset(slug) });
    const doing = async (action: () => Promise<unknown>) => {
      try {
        await action();
      } catch (error) {
        failed(error);
      }
      await refresh();
    };
    return {
      retry: (id: number) =>
        doing(async () => {
          const { queued } = await retryRun(id);
          toast({ message: `${formatQuantity(queued, "image")} queued again.`, key: `run-${id}` });
        }),
      cancel: (id: number) => doing(() => cancelRun(id)),
      remove: (id: number) =>
        doing(async () => {
          await deleteRun(id);
          toast({
            message: "Run deleted with its undecided candidates; what was decided stays.",
            action: { label: "Undo", run: () => void doing(() => restoreRun(id)) },
            duration: 10_000,
            key: `run-${id}`,
          });
        }),
    };
  }, [client, slug]);
}
