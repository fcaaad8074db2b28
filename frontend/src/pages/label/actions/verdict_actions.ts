import type { EditKind } from "../../../api/types";
import { formatQuantity } from "../../../design/format";
import { toast } from "../../../design/toast";
import { describeEditReplay } from "../../../labelling/drawing/edits";
import { type ChangeGroup, describeReplay } from "../../../labelling/history";
import type { LabelStore } from "../../../labelling/label_store";
import { changeShown } from "../filter/change_shown";
import { judgeSelection } from "../tools/judge_many";
import { dismissUndoToasts, HISTORY_TOAST, REJECTED_TOAST } from "./image_toasts";
import type { OverlayControl, PageActions } from "./page_actions";

const HISTORY_TOAST_DURATION = 2_500;

interface VerdictParts {
  store: LabelStore | null;
  overlays: OverlayControl;
  /** Shows an edit's lines again, or takes them away, if this group of decisions is one. */
  replayedEdit: (group: ChangeGroup) => EditKind | null;
  whenHistoryKnown: (act: () => void) => void;
}

type VerdictActions = Pick<
  PageActions,
  "step" | "judge" | "undo" | "redo" | "rejectUndecided" | "toggleRejected"
>;

/** Verdicts, and taking them back. */
export function verdictActions(parts: VerdictParts): VerdictActions {
  const { store, overlays, replayedEdit, whenHistoryKnown } = parts;

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
    dismissUndoToasts();
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

  return {
    step: (direction) => store?.step(direction),
    judge: (verdict) => {
      if (store !== null) judgeSelection(store, verdict);
    },
    undo: () => whenHistoryKnown(() => replay("undo")),
    redo: () => whenHistoryKnown(() => replay("redo")),
    rejectUndecided,
    toggleRejected,
  };
}

function messageOf(kind: "undo" | "redo", group: ChangeGroup | null, edit: EditKind | null): string {
  if (group === null) return `Nothing to ${kind}`;
  return edit === null ? describeReplay(kind, group) : describeEditReplay(kind, edit);
}
