import { Button } from "../../../design/button";
import { formatCount } from "../../../design/format";
import { type LabelState, verdictAt } from "../../../labelling/label_state";
import { isBeyond, type Measure, type Side } from "../../../labelling/ranges";
import { endText } from "./end_text";

const WORDS: Readonly<Record<Measure, Readonly<Record<Side, string>>>> = {
  length: { low: "shorter than", high: "longer than" },
  score: { low: "score below", high: "score above" },
  residual: { low: "residual below", high: "residual above" },
};

interface BeyondRowProps {
  state: LabelState;
  measure: Measure;
  side: Side;
  judges: boolean;
  onSelect: (indices: readonly number[]) => void;
  onReject: (indices: readonly number[]) => void;
}

/** How many lie beyond one end, with what can be done to them; those that are judged already are left alone. */
export function BeyondRow({ state, measure, side, judges, onSelect, onReject }: BeyondRowProps) {
  const range = state.shown.ranges[measure];
  const end = range[side];
  if (end === null) return null;
  const beyond = state.sequence.filter((index) => {
    const candidate = state.candidates[index];
    return candidate !== undefined && isBeyond(candidate, measure, side, range);
  });
  const undecided = beyond.filter((index) => verdictAt(state, index) === "undecided");
  const what = `${WORDS[measure][side]} ${endText(measure, end)}`;
  return (
    <div className="beyond-row">
      <span>
        <strong className="numeric">{formatCount(beyond.length)}</strong> {what}
        {undecided.length < beyond.length ? (
          <span className="muted">, {formatCount(undecided.length)} undecided</span>
        ) : null}
      </span>
      <span className="beyond-row__buttons">
        <Button
          small
          disabled={undecided.length === 0}
          aria-label={`Select the undecided ${what}`}
          title="Select the undecided ones"
          onClick={() => onSelect(undecided)}
        >
          Select
        </Button>
        {judges ? (
          <Button
            small
            disabled={undecided.length === 0}
            aria-label={`Reject the undecided ${what}`}
            title="Reject the undecided ones, as one step to undo"
            onClick={() => onReject(undecided)}
          >
            Reject
          </Button>
        ) : null}
      </span>
    </div>
  );
}
