import { useQueryClient } from "@tanstack/react-query";
import { type RefObject, useMemo } from "react";
import { useNavigate } from "react-router";
import { asProblem } from "../../api/problem";
import { putSecondReview, type SecondReview, secondReviewsQuery, teamKeys } from "../../api/team_endpoints";
import type { CanvasView } from "../../canvas/view";
import { formatQuantity } from "../../design/format";
import { toast } from "../../design/toast";
import { viewActions } from "../../image_view/view_actions";
import { describeReplay } from "../../labelling/history";
import type { LabelStore } from "../../labelling/label_store";
import type { SecondActions } from "./second_commands";
import { secondOutbox } from "./second_outbox";

interface ActionParts {
  slug: string;
  review: SecondReview;
  store: LabelStore | null;
  whenHistoryKnown: (act: () => void) => void;
  viewRef: RefObject<CanvasView | null>;
  panelRef: RefObject<HTMLElement | null>;
  keyList: boolean;
  toggleKeyList: () => void;
}

/** What keys and buttons do in a second review. */
export function useSecondActions(parts: ActionParts): SecondActions {
  const { slug, review, store, whenHistoryKnown, viewRef, panelRef, keyList, toggleKeyList } = parts;
  const navigate = useNavigate();
  const client = useQueryClient();
  return useMemo(() => {
    let finishing = false;

    async function finish(): Promise<void> {
      if (store === null || finishing) return;
      if (store.selectFirstUndecided()) {
        toast({
          key: "second",
          message: `${formatQuantity(store.getState().counts.undecided, "candidate")} left`,
        });
        return;
      }
      finishing = true;
      try {
        await secondOutbox.flush();
        await putSecondReview(review.id, "done");
        await client.invalidateQueries({ queryKey: teamKeys.agreement(slug) });
        const { due, reviews } = await client.fetchQuery({ ...secondReviewsQuery(slug), staleTime: 0 });
        const open = reviews.find(({ mine, status, id }) => mine && status === "open" && id !== review.id);
        const next = open?.image_id ?? due[0]?.image_id;
        if (next === undefined) {
          toast({
            key: "second",
            tone: "success",
            message: "Done; no other image waits for a second review.",
          });
          navigate(`/datasets/${slug}?tab=team`);
        } else {
          navigate(`/datasets/${slug}/second/${next}`);
        }
      } catch (error) {
        toast({ key: "second", tone: "danger", message: asProblem(error).message });
      } finally {
        finishing = false;
      }
    }

    function replay(kind: "undo" | "redo"): void {
      const group = (kind === "undo" ? store?.undo() : store?.redo()) ?? null;
      toast({
        key: "second",
        message: group === null ? `Nothing to ${kind}` : describeReplay(kind, group),
        duration: 2_500,
      });
    }

    function rejectUndecided(): void {
      const count = store?.rejectUndecided() ?? 0;
      if (count === 0) return;
      toast({
        key: "second",
        message: `${formatQuantity(count, "candidate")} rejected`,
        action: { label: "Undo", run: () => replay("undo") },
      });
    }

    function toggleRejected(): void {
      if (store === null) return;
      const { shown } = store.getState();
      store.setShown({ ...shown, verdicts: { ...shown.verdicts, reject: !shown.verdicts.reject } });
    }

    function leaveSelection(): void {
      if (keyList) toggleKeyList();
      else if (store !== null && store.getState().selected !== null) store.select(null);
      else panelRef.current?.focus();
    }

    return {
      judge: (verdict) => void store?.judgeSelected(verdict),
      rejectUndecided,
      undo: () => whenHistoryKnown(() => replay("undo")),
      redo: () => whenHistoryKnown(() => replay("redo")),
      step: (direction) => store?.step(direction),
      leaveSelection,
      toggleRejected,
      finish: () => void finish(),
      toggleKeyList,
      ...viewActions(() => viewRef.current),
    };
  }, [slug, review, store, whenHistoryKnown, viewRef, panelRef, keyList, toggleKeyList, navigate, client]);
}
