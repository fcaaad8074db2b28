import type { QueryClient } from "@tanstack/react-query";
import { getEdits } from "../../../api/endpoints";
import { keys } from "../../../api/queries";
import type { Edit } from "../../../api/types";
import { isOutOfDate } from "../../../labelling/drawing/edits";
import type { LabelStore } from "../../../labelling/label_store";
import { outbox } from "../../../labelling/outbox_start";
import { annotationsKey } from "../session/use_label_session";

const editsKey = (imageId: number) => [...keys.image(imageId), "edits"] as const;

/** Fetches an image's edits; candidates that were fetched before one of them are fetched again. */
export async function bringEdits(
  queryClient: QueryClient,
  imageId: number,
  store: LabelStore,
): Promise<readonly Edit[]> {
  const { edits } = await getEdits(imageId);
  queryClient.setQueryData(editsKey(imageId), edits);
  // What is still to be sent may be the undo of an edit: then whoever sent it reloads.
  const settled = outbox.pendingFor(imageId).length === 0;
  if (settled && isOutOfDate(edits, (id) => store.indexOfSegment(id) !== null)) {
    queryClient.invalidateQueries({ queryKey: annotationsKey(imageId) });
  }
  return edits;
}

/** The edit that a group of decisions belongs to; undefined where it is none. */
export function editOf(queryClient: QueryClient, imageId: number, groupId: string): Edit | undefined {
  return knownEdits(queryClient, imageId).find((edit) => edit.client_id === groupId);
}

/** Takes an edit that was just made to those that are known. */
export function noteEdit(queryClient: QueryClient, imageId: number, edit: Edit): void {
  queryClient.setQueryData(editsKey(imageId), [...knownEdits(queryClient, imageId), edit]);
}

function knownEdits(queryClient: QueryClient, imageId: number): readonly Edit[] {
  return queryClient.getQueryData<readonly Edit[]>(editsKey(imageId)) ?? [];
}
