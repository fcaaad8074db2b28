import { useSyncExternalStore } from "react";
import type { ImageDetail } from "../../../api/types";
import { IconButton } from "../../../design/button";
import { Keys } from "../../../design/kbd";
import { familyOfSelection } from "../../../labelling/families";
import { type HintId, nextHint } from "../../../labelling/hints/hints";
import { hintBook } from "../../../labelling/hints/hints_start";
import type { LabelState } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";
import { countSuggested } from "../../../labelling/suggestions/suggestions";
import { useLabelState } from "../session/use_store";
import "./hints.css";

/** One thing that a newcomer may not know yet, beside the keys that everybody needs. */
export function HintTip({ image, store }: { image: ImageDetail; store: LabelStore }) {
  const experience = useSyncExternalStore(hintBook.subscribe, hintBook.getState);
  const state = useLabelState(store);
  const hint = nextHint(experience, (id) => isPossible(id, image, state));
  if (hint === null) return null;
  return (
    <p className="hint-tip" role="note" aria-label="Hint">
      <Keys keys={[...hint.keys]} />
      <span>{hint.text}</span>
      <IconButton small icon="cross" label="I know" side="up" onClick={() => hintBook.learnt(hint.id)} />
    </p>
  );
}

function isPossible(id: HintId, image: ImageDetail, state: LabelState): boolean {
  switch (id) {
    case "rest":
    case "brush":
    case "lasso":
      return state.counts.undecided > 1;
    case "suggestions": {
      const { keep, reject } = countSuggested(state.suggesting, state.sequence);
      return keep + reject > 0;
    }
    case "turn":
      return state.suggesting.shown && state.counts.keep + state.counts.reject > 2;
    case "family":
      return state.selection.length === 1 && familyOfSelection(state).length > 1;
    case "take-over":
      return image.sequence !== null && state.counts.undecided > 0;
    default:
      return true;
  }
}
