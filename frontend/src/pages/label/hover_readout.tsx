import { isBent, verdictAt } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import type { PointerPlace } from "./canvas_region";
import { useLabelState } from "./use_store";
import { VerdictMark } from "./verdict_mark";

/** What lies under the pointer, beside it. */
export function HoverReadout({ store, pointer }: { store: LabelStore; pointer: PointerPlace }) {
  const state = useLabelState(store);
  const { index, screen } = pointer;
  const candidate = state.candidates[index];
  if (candidate === undefined) return null;
  const verdict = verdictAt(state, index);
  return (
    <div
      className="hover-readout"
      aria-hidden="true"
      style={{ transform: `translate(${Math.round(screen.x + 16)}px, ${Math.round(screen.y + 18)}px)` }}
    >
      <VerdictMark name={verdict === "undecided" && isBent(state, index) ? "bent" : verdict} />
      <span>{verdict}</span>
      <span className="numeric">{candidate.length.toFixed(0)} px</span>
      {candidate.score === null ? null : <span className="numeric">score {candidate.score.toFixed(2)}</span>}
    </div>
  );
}
