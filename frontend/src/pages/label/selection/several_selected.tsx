import { formatCount } from "../../../design/format";
import { VerdictBar } from "../../../design/progress";
import { type LabelState, verdictAt } from "../../../labelling/label_state";
import { countVerdicts, VERDICTS } from "../../../labelling/verdicts";

/** What is known of several selected candidates together. */
export function SeveralSelected({ state }: { state: LabelState }) {
  const counts = countVerdicts(state.selection.map((index) => verdictAt(state, index)));
  const said = VERDICTS.filter((verdict) => counts[verdict] > 0).map(
    (verdict) => `${formatCount(counts[verdict])} ${verdict}`,
  );
  return (
    <div className="several-selected">
      <VerdictBar counts={counts} />
      <p className="panel-hint">
        <span className="muted">{said.join(", ")}.</span> One verdict goes to all of them, as one step to
        undo.
      </p>
    </div>
  );
}
