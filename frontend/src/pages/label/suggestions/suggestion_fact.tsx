import { reasonPhrase } from "../../../labelling/suggestions/feature_words";
import { type Suggesting, suggestionAt, verdictFor } from "../../../labelling/suggestions/suggestions";
import { VerdictMark } from "../selection/verdict_mark";

const MARKS = { keep: "suggestedKeep", reject: "suggestedReject" } as const;
const WORDS = { keep: "Keep", reject: "Reject" } as const;
/** Reasons told beside the pointer. */
const FEW = 2;

/** What is suggested for one candidate, and why. */
export function SuggestionFact({ suggesting, index }: { suggesting: Suggesting; index: number }) {
  const suggestion = suggestionAt(suggesting, index);
  if (suggestion === null) return null;
  const verdict = verdictFor(suggestion.probability, suggesting.thresholds);
  return (
    <div className="suggestion-fact" data-testid="suggestion">
      <p className="suggestion-fact__verdict">
        <VerdictMark name={verdict === null ? "undecided" : MARKS[verdict]} />
        <strong>{verdict === null ? "No suggestion" : WORDS[verdict]}</strong>
        <span className="muted numeric">keep {Math.round(100 * suggestion.probability)} %</span>
      </p>
      <Reasons sign="+" label="For it" features={suggestion.for} />
      <Reasons sign="−" label="Against it" features={suggestion.against} />
    </div>
  );
}

function Reasons({ sign, label, features }: { sign: string; label: string; features: readonly string[] }) {
  if (features.length === 0) return null;
  return (
    <p className="suggestion-fact__reasons">
      <span className="suggestion-fact__sign" aria-hidden="true">
        {sign}
      </span>
      <span className="visually-hidden">{label}: </span>
      {reasonPhrase(features)}
    </p>
  );
}

/** The same in a few words, beside the pointer. */
export function SuggestionWords({ suggesting, index }: { suggesting: Suggesting; index: number }) {
  const suggestion = suggestionAt(suggesting, index);
  if (suggestion === null) return null;
  const likely = suggestion.probability >= 0.5;
  const reasons = likely ? suggestion.for : suggestion.against;
  return (
    <>
      <span className="numeric">keep {Math.round(100 * suggestion.probability)} %</span>
      {reasons.length > 0 ? (
        <span className="suggestion-words">
          {likely ? "+" : "−"} {reasonPhrase(reasons, FEW)}
        </span>
      ) : null}
    </>
  );
}
