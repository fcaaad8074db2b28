import { describeSelection } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";
import { useLabelState } from "../session/use_store";

/** Tells screen readers what is selected. */
export function Announcer({ store }: { store: LabelStore }) {
  const state = useLabelState(store);
  return (
    <p id="label-selection" className="visually-hidden" aria-live="polite">
      {describeSelection(state)}
    </p>
  );
}
