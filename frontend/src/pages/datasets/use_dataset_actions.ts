import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { createDataset, deleteDataset, renameDataset, restoreDataset } from "../../api/endpoints";
import { RequestFailed } from "../../api/problem";
import { keys } from "../../api/queries";
import type { Dataset } from "../../api/types";
import { formatDay, sentence } from "../../design/format";
import { toast } from "../../design/toast";
import { freeNames } from "./free_names";

const NAMES_TRIED = 20;

/** Changes of datasets, with the lists that follow them. A failure is shown, or thrown where a form shows it. */
export function useDatasetActions() {
  const client = useQueryClient();
  return useMemo(() => {
    const refresh = () => client.invalidateQueries({ queryKey: keys.datasets });

    async function create(name: string): Promise<Dataset> {
      const dataset = await createDataset(name);
      await refresh();
      return dataset;
    }

    /** For a name that nobody typed: where it is taken, a number is added. */
    async function createFor(name: string): Promise<Dataset> {
      let taken: unknown;
      for (const candidate of freeNames(name, NAMES_TRIED)) {
        try {
          return await create(candidate);
        } catch (error) {
          if (!(error instanceof RequestFailed) || error.problem.status !== 409) throw error;
          taken = error;
        }
      }
      throw taken;
    }

    async function rename(dataset: Dataset, name: string): Promise<void> {
      await renameDataset(dataset.slug, name);
      await refresh();
    }

    async function restore(dataset: Dataset): Promise<void> {
      try {
        await restoreDataset(dataset.slug);
        toast({ tone: "success", message: `${dataset.name} is back.`, key: `dataset-${dataset.slug}` });
      } catch (error) {
        failed(error);
      }
      await refresh();
    }

    async function remove(dataset: Dataset): Promise<boolean> {
      try {
        const { restorable_until } = await deleteDataset(dataset.slug);
        toast({
          message: `${dataset.name} deleted. It can be restored until ${formatDay(restorable_until)}.`,
          action: { label: "Undo", run: () => void restore(dataset) },
          duration: 10_000,
          key: `dataset-${dataset.slug}`,
        });
      } catch (error) {
        failed(error);
        return false;
      }
      await refresh();
      return true;
    }

    return { create, createFor, rename, remove, restore };
  }, [client]);
}

export function failed(error: unknown): void {
  toast({ tone: "danger", message: sentence(error instanceof Error ? error.message : String(error)) });
}
