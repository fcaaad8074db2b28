import type { RejectReason, Verdict } from "../../../api/types";
import { formatQuantity } from "../../../design/format";
import { toast } from "../../../design/toast";
import type { LabelStore } from "../../../labelling/label_store";
import { REASON_NAMES } from "../../../labelling/reasons";
import { MANY_TOAST } from "../actions/image_toasts";

const DURATION = 4_000;

export const DONE: Readonly<Record<Verdict, string>> = {
  keep: "kept",
  reject: "rejected",
  ambiguous: "marked ambiguous",
  undecided: "back to undecided",
};

/** One verdict for several candidates; what may lie anywhere on the image is said, with its undo. */
export function judgeMany(
  store: LabelStore,
  indices: readonly number[],
  verdict: Verdict,
  reason?: RejectReason,
): void {
  if (store.judge(indices, verdict, { reason })) tellMany(store, doneText(verdict, reason));
}

/** A verdict each for several candidates, as one group. */
export function judgeEach(store: LabelStore, verdicts: ReadonlyMap<number, Verdict>, done: string): void {
  const given = [...verdicts].map(([index, verdict]) => ({ index, verdict }));
  if (store.decide(given)) tellMany(store, done);
}

function doneText(verdict: Verdict, reason: RejectReason | undefined): string {
  return reason === undefined ? DONE[verdict] : `${DONE[verdict]}: ${REASON_NAMES[reason].toLowerCase()}`;
}

/** Judges all that is selected as one group, and goes on. */
export function judgeSelection(store: LabelStore, verdict: Verdict, reason?: RejectReason): void {
  if (store.judgeSelected(verdict, { reason })) tellMany(store, doneText(verdict, reason));
}

/** Says what the latest group did to how many candidates; nothing where it was one alone. */
export function tellMany(store: LabelStore, done: string, { single = false } = {}): void {
  const group = store.getState().history.done.at(-1);
  if (group === undefined || (group.changes.length < 2 && !single)) return;
  toast({
    key: MANY_TOAST,
    message: `${formatQuantity(group.changes.length, "candidate")} ${done}`,
    duration: DURATION,
    // Only this group is meant: whatever was judged since has to be undone first, by its own key.
    action: {
      label: "Undo",
      run: () => store.getState().history.done.at(-1)?.id === group.id && store.undo(),
    },
  });
}
