import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useSyncExternalStore } from "react";
import { toast } from "../../../design/toast";
import { outbox } from "../../../labelling/outbox_start";
import { annotationsKey } from "../session/use_label_session";

/** A decision that the server refuses for good is said, and the server's state shown. */
export function useRefusedDecisions(imageId: number): void {
  const queryClient = useQueryClient();
  const saving = useSyncExternalStore(outbox.subscribe, outbox.getState);
  useEffect(() => {
    if (saving.kind !== "refused") return;
    const message = saving.refused[0]?.problem.message ?? "The server refused a decision.";
    toast({ key: "refused", tone: "danger", message: `${message} The server's state is shown.` });
    queryClient.invalidateQueries({ queryKey: annotationsKey(imageId) });
    outbox.dismissRefused();
  }, [saving, queryClient, imageId]);
}
