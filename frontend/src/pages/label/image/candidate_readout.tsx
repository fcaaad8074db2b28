import { HoverReadout } from "../../../image_view/hover_readout";
import type { PointerPlace } from "../../../image_view/image_canvas";
import { isBent, verdictAt } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";
import { VerdictMark } from "../selection/verdict_mark";
import { useLabelState } from "../session/use_store";
import { SuggestionWords } from "../suggestions/suggestion_fact";

/** The candidate under the pointer. */
export function CandidateReadout({ store, pointer }: { store: LabelStore; pointer: PointerPlace }) {
  const state = useLabelState(store);
  const { index, screen } = pointer;
  const candidate = index === null ? undefined : state.candidates[index];
  if (index === null || candidate === undefined) return null;
  const verdict = verdictAt(state, index);
  return (
    <HoverReadout screen={screen}>
      <VerdictMark name={verdict === "undecided" && isBent(state, index) ? "bent" : verdict} />
      <span>{verdict}</span>
      <span className="numeric">{candidate.length.toFixed(0)} px</span>
      {candidate.score === null ? null : <span className="numeric">score {candidate.score.toFixed(2)}</span>}
      <SuggestionWords suggesting={state.suggesting} index={index} />
    </HoverReadout>
  );
}
