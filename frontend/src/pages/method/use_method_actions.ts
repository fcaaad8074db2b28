import { useQueryClient } from "@tanstack/react-query";
import { changeMethod } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import type { Method, MethodChanges } from "../../api/board_types";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

export function useMethodActions(method: Method) {
  const client = useQueryClient();

  async function change(changes: MethodChanges): Promise<void> {
    const changed = await changeMethod(method.slug, changes);
    client.setQueryData(boardKeys.method(method.slug), changed);
    void client.invalidateQueries({ queryKey: boardKeys.splits });
  }

  async function reveal(): Promise<void> {
    try {
      await change({ anonymous: false });
      toast({ tone: "success", message: "Your name now stands beside this method." });
    } catch (error) {
      failed(error);
    }
  }

  return { change, reveal };
}
