import { useMemo } from "react";
import { getNeighbourVerdicts } from "../../../api/endpoints";
import { asProblem } from "../../../api/problem";
import type { ImageDetail, RejectReason } from "../../../api/types";
import { toast } from "../../../design/toast";
import type { ToolActions } from "../../../labelling/commands_tools";
import { familyOfSelection } from "../../../labelling/families";
import { FOCUSES, isShown, reasonAt, verdictAt } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";
import { toolBox } from "../../../labelling/tools/tools_start";
import { MANY_TOAST } from "../actions/image_toasts";
import { changeShown } from "../filter/change_shown";
import { judgeSelection, tellMany } from "./judge_many";

const FOCUS_NAMES = {
  all: "All candidates shown",
  dim: "The others are faint",
  solo: "The others are hidden",
};
const FOCUS_TOAST_DURATION = 1_500;

/** What the keys for many candidates do. */
export function useToolActions(image: ImageDetail | undefined, store: LabelStore | null): ToolActions {
  return useMemo(
    () => ({
      holdTool: (name) => toolBox.hold(name),
      selectShown: () => {
        const state = store?.getState();
        if (state !== undefined) store?.selectAll(state.sequence.filter((index) => isShown(state, index)));
      },
      selectFamily: () => store?.selectAll(familyOfSelection(store.getState())),
      judgeFamily: (verdict) => {
        if (store === null) return;
        store.selectAll(familyOfSelection(store.getState()));
        judgeSelection(store, verdict);
      },
      rejectFor: (reason) => {
        if (store !== null) judgeSelection(store, "reject", reason);
      },
      chooseReason: (reason) => {
        if (store !== null) chooseReason(store, reason);
      },
      takeOver: () => {
        if (image !== undefined && store !== null) takeOver(image, store);
      },
      cycleFocus: () => {
        if (store === null) return;
        const { shown } = store.getState();
        const focus = FOCUSES[(FOCUSES.indexOf(shown.focus) + 1) % FOCUSES.length] ?? "all";
        changeShown(store, { ...shown, focus });
        toast({ key: "focus", message: FOCUS_NAMES[focus], duration: FOCUS_TOAST_DURATION });
      },
    }),
    [image, store],
  );
}

function chooseReason(store: LabelStore, reason: RejectReason): void {
  const state = store.getState();
  if (state.selection.some((index) => verdictAt(state, index) !== "reject")) {
    judgeSelection(store, "reject", reason);
    return;
  }
  const taken = state.selection.every((index) => reasonAt(state, index) === reason);
  store.judge(state.selection, "reject", { reason: taken ? null : reason });
}

/** Verdicts of the same edges in the frames beside, for what is undecided here. */
async function takeOver(image: ImageDetail, store: LabelStore): Promise<void> {
  try {
    const verdicts = await getNeighbourVerdicts(image.id);
    const given = verdicts.flatMap(({ segment_id, verdict, reason }) => {
      const index = store.indexOfSegment(segment_id);
      if (index === null || verdictAt(store.getState(), index) !== "undecided") return [];
      return [{ index, verdict, reason }];
    });
    if (given.length > 0 && store.decide(given, "take_over")) {
      tellMany(store, "judged as in the frames beside", { single: true });
    } else {
      toast({ key: MANY_TOAST, message: "Nothing to take over from the frames beside" });
    }
  } catch (error) {
    toast({ key: MANY_TOAST, tone: "danger", message: asProblem(error).message });
  }
}
