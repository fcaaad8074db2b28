import { useQueryClient } from "@tanstack/react-query";
import { type RefObject, useMemo } from "react";
import { useNavigate } from "react-router";
import { putReview } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { imageQuery } from "../../api/queries";
import type { EditKind, ImageDetail, Recall, ReviewStatus } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { formatQuantity } from "../../design/format";
import { dismissToast, toast } from "../../design/toast";
import type { LabelActions } from "../../labelling/commands";
import type { ToolActions } from "../../labelling/commands_tools";
import type { DrawingActions } from "../../labelling/drawing/commands_drawing";
import { describeEditReplay } from "../../labelling/drawing/edits";
import type { TraceSession } from "../../labelling/drawing/trace_session";
import { type ChangeGroup, describeReplay } from "../../labelling/history";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import type { SuggestionActions } from "../../labelling/suggestions/commands_suggestions";
import { toolBox } from "../../labelling/tools/tools_start";
import type { ViewsActions } from "../../labelling/views/commands_views";
import { changeShown } from "./change_shown";
import { EDIT_TOAST } from "./drawing/use_edits";
import { LOOKING_ONLY } from "./looking_only";
import { judgeSelection, MANY_TOAST } from "./tools/judge_many";

/** Have to go with their image: undo never reaches into another one. */
export const REJECTED_TOAST = "reject-undecided";
export const HISTORY_TOAST = "history";
const HISTORY_TOAST_DURATION = 2_500;
/** The dataset's rules want to know how complete the labels are. */
const RECALL_ASKED = "recall-asked";

interface ActionParts {
  /** Whether verdicts may be given at all. */
  judges: boolean;
  /** Why not; null where they may. */
  why: string | null;
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
  /** How the image is shown. */
  views: ViewsActions;
  /** For many candidates at once. */
  tools: ToolActions;
  suggestions: SuggestionActions;
  /** Lines by hand. */
  drawing: DrawingActions;
  /** The line that is being traced. */
  session: TraceSession;
  /** Shows an edit's lines again, or takes them away, if this group of decisions is one. */
  replayedEdit: (group: ChangeGroup) => EditKind | null;
  whenHistoryKnown: (act: () => void) => void;
}

/** What may lie beside or above the image. */
interface Overlays {
  toggleKeyList: () => void;
  toggleStages: () => void;
  toggleJump: () => void;
  toggleGuidelines: () => void;
  setLeftHint: (visible: boolean) => void;
  setRecall: (visible: boolean) => void;
  setDiscarding: (visible: boolean) => void;
  /** Closes whatever is open; false where nothing was. */
  close: () => boolean;
}

export interface PageActions extends LabelActions {
  goTo: (imageId: number) => void;
  setReview: (status: ReviewStatus, reason?: string) => Promise<boolean>;
  /** The image is done, and its labels are as complete as this. */
  answerRecall: (recall: Recall) => Promise<void>;
}

/** What keys and buttons do, on this page's store, view and router. */
export function useLabelActions(parts: ActionParts): PageActions {
  const {
    judges,
    why,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
    overlays,
    views,
    tools,
    suggestions,
    drawing,
    session,
    replayedEdit,
    whenHistoryKnown,
  } = parts;
  const navigate = useNavigate();
  const queryClient = useQueryClient();
  return useMemo(() => {
    const goTo = (id: number) => navigate(`/datasets/${slug}/images/${id}`);

    async function setReview(
      status: ReviewStatus,
      reason: string | null = null,
      recall: Recall | null = null,
    ): Promise<boolean> {
      if (image === undefined) return false;
      try {
        await outbox.flush();
        const answer = await putReview(image.id, status, reason, recall);
        queryClient.setQueryData(
          imageQuery(image.id).queryKey,
          (known) => known && { ...known, status: answer.status, reason },
        );
        overlays.setDiscarding(false);
        return true;
      } catch (error) {
        const problem = asProblem(error);
        if (problem.code === RECALL_ASKED) {
          overlays.setRecall(true);
          return false;
        }
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
      // As long as a line is being traced, the key accepts it.
      if (session.getState().clicks.length > 0) {
        await session.accept();
        return;
      }
      if (image === undefined || store === null || finishing) return;
      if (image.status !== "discarded" && store.selectFirstUndecided()) {
        overlays.setLeftHint(true);
        return;
      }
      finishing = true;
      if (image.status !== "open" || (await setReview("done"))) await goToNextOpen();
      finishing = false;
    }

    async function answerRecall(recall: Recall): Promise<void> {
      if (finishing) return;
      finishing = true;
      overlays.setRecall(false);
      if (await setReview("done", null, recall)) await goToNextOpen();
      finishing = false;
    }

    /** What was done shows on the image; what is taken back may lie anywhere on it. */
    function replay(kind: "undo" | "redo"): void {
      if (store === null) return;
      const group = kind === "undo" ? store.undo() : store.redo();
      const edit = group === null ? null : replayedEdit(group);
      toast({
        key: HISTORY_TOAST,
        message: messageOf(kind, group, edit),
        duration: HISTORY_TOAST_DURATION,
      });
      dismissToast(REJECTED_TOAST);
      dismissToast(MANY_TOAST);
      dismissToast(EDIT_TOAST);
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
      changeShown(store, { ...shown, verdicts: { ...shown.verdicts, reject: !shown.verdicts.reject } });
    }

    function goToImage(direction: 1 | -1): void {
      const id = direction === 1 ? image?.next_id : image?.previous_id;
      if (id !== null && id !== undefined) goTo(id);
    }

    function leaveSelection(): void {
      if (viewRef.current?.cancelDrag() || toolBox.layAside()) return;
      // What had the focus may be gone with what is closed.
      if (overlays.close()) enterImage();
      else if (store !== null && store.getState().selected !== null) store.select(null);
      else leaveImage();
    }

    const actions: PageActions = {
      step: (direction) => store?.step(direction),
      judge: (verdict) => {
        if (store !== null) judgeSelection(store, verdict);
      },
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
      toggleJump: overlays.toggleJump,
      toggleGuidelines: overlays.toggleGuidelines,
      goTo,
      stepJoin,
      ...views,
      ...suggestions,
      ...tools,
      ...drawing,
      fit: () => viewRef.current?.fit(),
      zoom: (direction) => viewRef.current?.zoomStep(direction),
      pan: (dx, dy) => viewRef.current?.panStep(dx, dy),
      setReview,
      answerRecall,
    };
    return judges ? actions : { ...actions, ...lookingOnly(why ?? LOOKING_ONLY, () => goToImage(1)) };
  }, [
    judges,
    why,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
    overlays,
    views,
    tools,
    suggestions,
    drawing,
    session,
    replayedEdit,
    whenHistoryKnown,
    navigate,
    queryClient,
  ]);
}

function messageOf(kind: "undo" | "redo", group: ChangeGroup | null, edit: EditKind | null): string {
  if (group === null) return `Nothing to ${kind}`;
  return edit === null ? describeReplay(kind, group) : describeEditReplay(kind, edit);
}

/** What takes the place of all that changes something, for whoever may only look. */
function lookingOnly(why: string, next: () => void): Partial<PageActions> {
  const refuse = () => toast({ key: "looking-only", message: why });
  return {
    judge: refuse,
    undo: refuse,
    redo: refuse,
    rejectUndecided: refuse,
    acceptSuggestions: refuse,
    discard: refuse,
    toggleStages: refuse,
    holdTool: (name) => (name === "lasso" ? toolBox.hold(name) : refuse()),
    judgeFamily: refuse,
    rejectFor: refuse,
    chooseReason: refuse,
    takeOver: refuse,
    toggleTrace: refuse,
    cutLine: refuse,
    trimLine: refuse,
    joinLines: refuse,
    extendLine: refuse,
    stepJoin: () => undefined,
    finish: next,
    setReview: async () => {
      refuse();
      return false;
    },
  };
}
