import { type QueryClient, useQueryClient } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { postEdit } from "../../../api/endpoints";
import { asProblem, RequestFailed } from "../../../api/problem";
import type { EditKind, NewEdit } from "../../../api/types";
import type { Point } from "../../../canvas/geometry";
import { sentence } from "../../../design/format";
import { toast } from "../../../design/toast";
import type { Annotations } from "../../../labelling/annotations";
import { describeEdit } from "../../../labelling/drawing/edits";
import type { ChangeGroup } from "../../../labelling/history";
import { outbox, seenDecisions } from "../../../labelling/outbox_start";
import { describeStaleEdit } from "../../../labelling/people/stale_decisions";
import { EDIT_TOAST } from "../actions/image_toasts";
import { annotationsKey } from "../session/use_label_session";
import { editOf, noteEdit } from "./known_edits";
import type { LatestEdit } from "./use_carried_selection";

export interface Edits {
  /**
   * Makes an edit and shows what it left.
   *
   * @throws RequestFailed when it wasn't made, or nobody knows.
   */
  make(edit: NewEdit): Promise<void>;
  /** The same, one at a time, with a message where it fails. */
  change(kind: EditKind, replaces: number[], at?: Point): Promise<void>;
  /** Shows an edit's lines again, or takes them away, if this group of decisions is one; gives its kind. */
  replayed(group: ChangeGroup): EditKind | null;
}

/** Edits of an image's lines, each saved at once. */
export function useEdits(imageId: number, latest: LatestEdit, undo: (groupId: string) => void): Edits {
  const queryClient = useQueryClient();
  const [busy] = useState(() => ({ now: false }));
  return useMemo(() => {
    const reload = () => queryClient.invalidateQueries({ queryKey: annotationsKey(imageId) });

    async function make(edit: NewEdit): Promise<void> {
      // Verdicts first: the server knows what was decided on a line before it is replaced.
      await outbox.flush();
      const stored = await postEdit(imageId, { ...edit, seen: seenDecisions.of(imageId) });
      noteEdit(queryClient, imageId, stored);
      latest.edit = stored;
      await reload();
      toast({
        key: EDIT_TOAST,
        message: describeEdit(stored.kind, lengthsOf(queryClient, imageId, stored.added)),
        action: { label: "Undo", run: () => undo(stored.client_id) },
      });
    }

    async function change(kind: EditKind, replaces: number[], at?: Point): Promise<void> {
      if (busy.now) return;
      busy.now = true;
      try {
        const edit: NewEdit = { client_id: crypto.randomUUID(), kind, replaces };
        await make(at === undefined ? edit : { ...edit, at: [at.x, at.y] });
      } catch (error) {
        const problem = asProblem(error);
        const { message, hint } = problem;
        const told = hint ? `${sentence(message)} ${sentence(hint)}` : sentence(message);
        toast({ key: EDIT_TOAST, tone: "danger", message: describeStaleEdit(problem) ?? told });
        // Somebody else's edit or verdict is shown: this one can't be made, or not unseen.
        if (error instanceof RequestFailed && error.problem.status === 409) reload();
      } finally {
        busy.now = false;
      }
    }

    function replayed(group: ChangeGroup): EditKind | null {
      const edit = editOf(queryClient, imageId, group.id);
      if (edit === undefined) return null;
      whenSent(() => {
        latest.edit = edit;
        reload();
      });
      return edit.kind;
    }

    return { make, change, replayed };
  }, [queryClient, imageId, latest, undo, busy]);
}

/** Runs something once the server has every decision, however long the network is away. */
function whenSent(act: () => void): void {
  let stop: (() => void) | null = null;
  const look = () => {
    const { kind } = outbox.getState();
    if (kind !== "saved" && kind !== "refused") return false;
    stop?.();
    act();
    return true;
  };
  if (!look()) stop = outbox.subscribe(look);
}

function lengthsOf(queryClient: QueryClient, imageId: number, added: readonly number[]): number[] {
  const annotations = queryClient.getQueryData<Annotations>(annotationsKey(imageId));
  const candidates = annotations?.candidates ?? [];
  return candidates.filter(({ id }) => added.includes(id)).map(({ length }) => length);
}
