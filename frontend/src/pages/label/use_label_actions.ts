import { useQueryClient } from "@tanstack/react-query";
import { type RefObject, useMemo } from "react";
import { useNavigate } from "react-router";
import { listImages, putReview } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { imageQuery } from "../../api/queries";
import type { ImageDetail, ReviewStatus } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { formatQuantity } from "../../design/format";
import { toast } from "../../design/toast";
import type { LabelActions } from "../../labelling/commands";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import { readPreferences, writePreferences } from "../../labelling/preferences";

/** Has to go with its image: undo never reaches into another one. */
export const REJECTED_TOAST = "reject-undecided";

interface ActionParts {
  slug: string;
  image: ImageDetail | undefined;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  /** Moves the focus from the image to the panel. */
  leaveImage: () => void;
  toggleKeyList: () => void;
  setLeftHint: (visible: boolean) => void;
}

export interface PageActions extends LabelActions {
  setReview: (status: ReviewStatus) => Promise<boolean>;
}

/** What keys and buttons do, on this page's store, view and router. */
export function useLabelActions(parts: ActionParts): PageActions {
  const { slug, image, store, viewRef, leaveImage, toggleKeyList, setLeftHint } = parts;
  const navigate = useNavigate();
  const queryClient = useQueryClient();
  return useMemo(() => {
    const goTo = (id: number) => navigate(`/datasets/${slug}/images/${id}`);

    async function setReview(status: ReviewStatus): Promise<boolean> {
      if (image === undefined) return false;
      try {
        await outbox.flush();
        const answer = await putReview(image.id, status);
        queryClient.setQueryData(
          imageQuery(image.id).queryKey,
          (known) => known && { ...known, status: answer.status },
        );
        return true;
      } catch (error) {
        const problem = asProblem(error);
        toast({ key: "review", tone: "danger", message: problem.message });
        return false;
      }
    }

    async function goToNextOpen(): Promise<void> {
      if (image === undefined) return;
      const open = await listImages(slug, { status: "open" }, null, 1).catch(() => null);
      const next = image.next_open_id ?? open?.items.find((other) => other.id !== image.id)?.id;
      if (next !== undefined && next !== image.id && open?.total !== 0) goTo(next);
      else navigate(`/datasets/${slug}/finished`);
    }

    async function finish(): Promise<void> {
      if (image === undefined || store === null) return;
      if (image.status !== "discarded" && store.selectFirstUndecided()) {
        setLeftHint(true);
        return;
      }
      if (image.status !== "open" || (await setReview("done"))) await goToNextOpen();
    }

    const latestGroup = () => store?.getState().history.done.at(-1)?.id;

    function rejectUndecided(): void {
      const count = store?.rejectUndecided() ?? 0;
      setLeftHint(false);
      if (count === 0) return;
      const rejection = latestGroup();
      toast({
        key: REJECTED_TOAST,
        message: `${formatQuantity(count, "candidate")} rejected`,
        // Only this rejection is meant: whatever was judged since has to be undone first, by its own key.
        action: { label: "Undo", run: () => latestGroup() === rejection && store?.undo() },
      });
    }

    function toggleRejected(): void {
      if (store === null) return;
      const { shown } = store.getState();
      const next = { ...shown, verdicts: { ...shown.verdicts, reject: !shown.verdicts.reject } };
      store.setShown(next);
      writePreferences(localStorage, { ...readPreferences(localStorage), shown: next });
    }

    function goToImage(direction: 1 | -1): void {
      const id = direction === 1 ? image?.next_id : image?.previous_id;
      if (id !== null && id !== undefined) goTo(id);
    }

    function leaveSelection(): void {
      setLeftHint(false);
      if (store !== null && store.getState().selected !== null) store.select(null);
      else leaveImage();
    }

    return {
      step: (direction) => store?.step(direction),
      judge: (verdict) => store?.judgeSelected(verdict),
      undo: () => store?.undo(),
      redo: () => store?.redo(),
      rejectUndecided,
      toggleRejected,
      finish,
      goToImage,
      leaveSelection,
      toggleKeyList,
      fit: () => viewRef.current?.fit(),
      zoom: (direction) => viewRef.current?.zoomStep(direction),
      pan: (dx, dy) => viewRef.current?.panStep(dx, dy),
      setReview,
    };
  }, [slug, image, store, viewRef, leaveImage, toggleKeyList, setLeftHint, navigate, queryClient]);
}
