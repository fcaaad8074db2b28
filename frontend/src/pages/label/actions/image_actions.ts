import type { QueryClient } from "@tanstack/react-query";
import { putReview } from "../../../api/endpoints";
import { asProblem } from "../../../api/problem";
import { imageQuery } from "../../../api/queries";
import type { ImageDetail, Recall, ReviewStatus } from "../../../api/types";
import { toast } from "../../../design/toast";
import type { TraceSession } from "../../../labelling/drawing/trace_session";
import type { LabelStore } from "../../../labelling/label_store";
import { outbox } from "../../../labelling/outbox_start";
import type { OverlayControl, PageActions } from "./page_actions";

/** The dataset's rules want to know how complete the labels are. */
const RECALL_ASKED = "recall-asked";

interface ImageParts {
  slug: string;
  image: ImageDetail;
  store: LabelStore | null;
  overlays: OverlayControl;
  /** The line that is being traced. */
  session: TraceSession;
  navigate: (path: string, how?: { flushSync: boolean }) => void;
  queryClient: QueryClient;
}

type ImageActions = Pick<
  PageActions,
  "goTo" | "goToImage" | "finish" | "discard" | "setReview" | "answerRecall"
>;

/** What becomes of an image as a whole, and the way to the next one. */
export function imageActions(parts: ImageParts): ImageActions {
  const { slug, image, store, overlays, session, navigate, queryClient } = parts;

  // At once: as a transition, which the router makes of it, the image would wait for its turn.
  const goTo = (id: number) => navigate(`/datasets/${slug}/images/${id}`, { flushSync: true });

  async function setReview(
    status: ReviewStatus,
    reason: string | null = null,
    recall: Recall | null = null,
  ): Promise<boolean> {
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
    // What was fetched ahead may name an image that has been finished since.
    const fresh = await queryClient.fetchQuery({ ...imageQuery(image.id), staleTime: 0 }).catch(() => image);
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
    if (store === null || finishing) return;
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

  function goToImage(direction: 1 | -1): void {
    const id = direction === 1 ? image.next_id : image.previous_id;
    if (id !== null) goTo(id);
  }

  return {
    goTo,
    goToImage,
    finish,
    discard: () => overlays.setDiscarding(image.status !== "discarded"),
    setReview,
    answerRecall,
  };
}
