import { useQueryClient } from "@tanstack/react-query";
import { type RefObject, useMemo } from "react";
import { useNavigate } from "react-router";
import { putReview } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { imageQuery } from "../../api/queries";
import type { ImageDetail, ReviewStatus } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { formatQuantity } from "../../design/format";
import { dismissToast, toast } from "../../design/toast";
import type { LabelActions } from "../../labelling/commands";
import { describeReplay } from "../../labelling/history";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import { readPreferences, writePreferences } from "../../labelling/preferences";
import { LOOKING_ONLY } from "./looking_only";

/** Have to go with their image: undo never reaches into another one. */
export const REJECTED_TOAST = "reject-undecided";
export const HISTORY_TOAST = "history";
const HISTORY_TOAST_DURATION = 2_500;

interface ActionParts {
  /** Whether verdicts may be given at all. */
  judges: boolean;
  slug: string;
  image: ImageDetail | undefined;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  /** Moves the focus from the image to the panel. */
  leaveImage: () => void;
  /** Moves the focus to the image. */
  enterImage: () => void;
  /** Moves the focus through what joined the selected candidate's pieces. */
  stepJoin: (direction: 1 | -1) => void;
  overlays: Overlays;
  whenHistoryKnown: (act: () => void) => void;
}

/** What may lie beside or above the image. */
interface Overlays {
  toggleKeyList: () => void;
  toggleStages: () => void;
  setLeftHint: (visible: boolean) => void;
  setDiscarding: (visible: boolean) => void;
  /** Closes whatever is open; false where nothing was. */
  close: () => boolean;
}

export interface PageActions extends LabelActions {
  setReview: (status: ReviewStatus, reason?: string) => Promise<boolean>;
}

/** What keys and buttons do, on this page's store, view and router. */
export function useLabelActions(parts: ActionParts): PageActions {
  const {
    judges,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
    overlays,
    whenHistoryKnown,
  } = parts;
  const navigate = useNavigate();
  const queryClient = useQueryClient();
  return useMemo(() => {
    const goTo = (id: number) => navigate(`/datasets/${slug}/images/${id}`);

    async function setReview(status: ReviewStatus, reason: string | null = null): Promise<boolean> {
      if (image === undefined) return false;
      try {
        await outbox.flush();
        const answer = await putReview(image.id, status, reason);
        queryClient.setQueryData(
          imageQuery(image.id).queryKey,
          (known) => known && { ...known, status: answer.status, reason },
        );
        overlays.setDiscarding(false);
        return true;
      } catch (error) {
        const problem = asProblem(error);
        toast({ key: "review", tone: "danger", message: problem.message });
        return false;
      }
    }

    async function goToNextOpen(): Promise<void> {
      if (image === undefined) return;
      // What was fetched ahead may name an image that has been finished since.
      const fresh = await queryClient
        .fetchQuery({ ...imageQuery(image.id), staleTime: 0 })
        .catch(() => image);
      const next = fresh.next_open_id;
      if (next !== null && next !== image.id) goTo(next);
      else navigate(`/datasets/${slug}/finished`);
    }

    let finishing = false;

    async function finish(): Promise<void> {
      if (image === undefined || store === null || finishing) return;
      if (image.status !== "discarded" && store.selectFirstUndecided()) {
        overlays.setLeftHint(true);
        return;
      }
      finishing = true;
      if (image.status !== "open" || (await setReview("done"))) await goToNextOpen();
      finishing = false;
    }

    /** What was done shows on the image; what is taken back may lie anywhere on it. */
    function replay(kind: "undo" | "redo"): void {
      if (store === null) return;
      const group = kind === "undo" ? store.undo() : store.redo();
      toast({
        key: HISTORY_TOAST,
        message: group === null ? `Nothing to ${kind}` : describeReplay(kind, group),
        duration: HISTORY_TOAST_DURATION,
      });
      dismissToast(REJECTED_TOAST);
    }

    const latestGroup = () => store?.getState().history.done.at(-1)?.id;

    function rejectUndecided(): void {
      const count = store?.rejectUndecided() ?? 0;
      overlays.setLeftHint(false);
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
      // What had the focus may be gone with what is closed.
      if (overlays.close()) enterImage();
      else if (store !== null && store.getState().selected !== null) store.select(null);
      else leaveImage();
    }

    const actions: PageActions = {
      step: (direction) => store?.step(direction),
      judge: (verdict) => store?.judgeSelected(verdict),
      undo: () => whenHistoryKnown(() => replay("undo")),
      redo: () => whenHistoryKnown(() => replay("redo")),
      rejectUndecided,
      toggleRejected,
      finish,
      goToImage,
      leaveSelection,
      discard: () => overlays.setDiscarding(image?.status !== "discarded"),
      toggleKeyList: overlays.toggleKeyList,
      toggleStages: overlays.toggleStages,
      stepJoin,
      fit: () => viewRef.current?.fit(),
      zoom: (direction) => viewRef.current?.zoomStep(direction),
      pan: (dx, dy) => viewRef.current?.panStep(dx, dy),
      setReview,
    };
    return judges ? actions : { ...actions, ...lookingOnly(() => goToImage(1)) };
  }, [
    judges,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
    overlays,
    whenHistoryKnown,
    navigate,
    queryClient,
  ]);
}

/** What takes the place of all that changes something, for whoever may only look. */
function lookingOnly(next: () => void): Partial<PageActions> {
  const refuse = () => toast({ key: "looking-only", message: LOOKING_ONLY });
  return {
    judge: refuse,
    undo: refuse,
    redo: refuse,
    rejectUndecided: refuse,
    discard: refuse,
    toggleStages: refuse,
    stepJoin: () => undefined,
    finish: next,
    setReview: async () => {
      refuse();
      return false;
    },
  };
}
