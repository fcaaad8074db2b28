import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import {
  changeSubmission,
  rescoreSubmission,
  restoreSubmission,
  withdrawSubmission,
} from "../api/board_endpoints";
import { boardKeys } from "../api/board_queries";
import type { Submission } from "../api/board_types";
import { toast } from "../design/toast";
import { failed } from "./datasets/use_dataset_actions";

/** Changes of submissions, with the lists and boards that follow them. */
export function useSubmissionActions() {
  const client = useQueryClient();
  return useMemo(() => {
    async function change(id: number, act: () => Promise<Submission>): Promise<Submission | null> {
      try {
        const changed = await act();
        client.setQueryData(boardKeys.submission(id), changed);
        void client.invalidateQueries({ queryKey: boardKeys.splits });
        void client.invalidateQueries({ queryKey: boardKeys.method(changed.method.slug) });
        return changed;
      } catch (error) {
        failed(error);
        return null;
      }
    }

    async function restore(id: number): Promise<void> {
      const restored = await change(id, () => restoreSubmission(id));
      if (restored) toast({ tone: "success", message: "The submission is back.", key: `submission-${id}` });
    }

    async function withdraw(submission: Submission): Promise<void> {
      const { id, method } = submission;
      const withdrawn = await change(id, () => withdrawSubmission(id));
      if (withdrawn === null) return;
      toast({
        message: `${method.name} withdrawn: it no longer stands on the board.`,
        action: { label: "Undo", run: () => void restore(id) },
        duration: 10_000,
        key: `submission-${id}`,
      });
    }

    async function setVisibility(id: number, visibility: Submission["visibility"]): Promise<void> {
      const changed = await change(id, () => changeSubmission(id, { visibility }));
      if (changed === null) return;
      const other = visibility === "public" ? "private" : "public";
      toast({
        message:
          visibility === "public" ? "Everyone sees it now." : "Only you and the maintainers see it now.",
        action: { label: "Undo", run: () => void setVisibility(id, other) },
        key: `submission-${id}`,
      });
    }

    async function relabel(id: number, label: string): Promise<void> {
      const changed = await changeSubmission(id, { label });
      client.setQueryData(boardKeys.submission(id), changed);
      void client.invalidateQueries({ queryKey: boardKeys.splits });
    }

    async function rescore(id: number): Promise<void> {
      const queued = await change(id, () => rescoreSubmission(id));
      if (queued) toast({ message: "It is scored again; the old numbers stay.", key: `submission-${id}` });
    }

    return { withdraw, restore, setVisibility, relabel, rescore };
  }, [client]);
}
