import { type RefObject, useMemo } from "react";
import { Link } from "react-router";
import type { CanvasView } from "../../../canvas/view";
import { Button, IconButton } from "../../../design/button";
import { formatCount, formatQuantity } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import { type LabelState, verdictAt } from "../../../labelling/label_state";
import { THRESHOLD_RANGES } from "../../../labelling/suggestions/preferences";
import { countSuggested } from "../../../labelling/suggestions/suggestions";
import { VerdictMark } from "../selection/verdict_mark";
import { useOnScreen } from "./use_on_screen";
import type { SuggestionSession } from "./use_suggestions";
import "./suggestions.css";

/** Where both thresholds meet. */
const MIDDLE = 0.5;

interface SuggestionSectionProps {
  slug: string;
  state: LabelState;
  viewRef: RefObject<CanvasView | null>;
  session: SuggestionSession;
}

/** What is suggested on the screen, from which probabilities on, and by which model. */
export function SuggestionSection({ slug, state, viewRef, session }: SuggestionSectionProps) {
  const { preferences, prefer, recommended, actions } = session;
  const { shown } = preferences;
  const onScreen = useOnScreen(viewRef, state);
  const counts = useMemo(
    () =>
      countSuggested(
        state.suggesting,
        onScreen.filter((index) => verdictAt(state, index) === "undecided"),
      ),
    [state, onScreen],
  );
  const { thresholds } = state.suggesting;
  const own = preferences.keep !== null || preferences.reject !== null;
  return (
    <section className="panel-section" aria-label="Suggestions">
      <div className="panel-heading">
        <h2>Suggestions</h2>
        <span className="panel-heading__end">
          <IconButton
            small
            icon={shown ? "eye" : "eyeOff"}
            label={shown ? "Hide suggestions" : "Show suggestions"}
            keys={["Shift", "S"]}
            side="end"
            aria-keyshortcuts="Shift+S"
            onClick={actions.toggleSuggestions}
          />
        </span>
      </div>
      {session.failed ? (
        <p className="muted panel-hint">They can't be had at the moment.</p>
      ) : recommended === null ? (
        <p className="muted panel-hint">Looking at the candidates…</p>
      ) : shown ? (
        <>
          <ThresholdSlider
            kind="keep"
            label="Keep from"
            value={thresholds.keep}
            count={counts.keep}
            onChange={(keep) => prefer({ ...preferences, keep })}
          />
          <ThresholdSlider
            kind="reject"
            label="Reject below"
            value={thresholds.reject}
            count={counts.reject}
            onChange={(reject) => prefer({ ...preferences, reject })}
          />
          <div className="suggestion-accept">
            <Button
              aria-keyshortcuts="S"
              disabled={counts.keep + counts.reject === 0}
              title="Of what is on the screen, by half at least"
              onClick={actions.acceptSuggestions}
            >
              {acceptText(counts)} <Keys keys={["S"]} />
            </Button>
            {own ? (
              <Button
                tone="quiet"
                title="The thresholds that the model recommends"
                onClick={() => prefer({ ...preferences, keep: null, reject: null })}
              >
                Reset
              </Button>
            ) : (
              <Button
                tone="quiet"
                title="Everything is suggested one way or the other: fewest keys, more to mend"
                onClick={() => prefer({ ...preferences, keep: MIDDLE, reject: MIDDLE })}
              >
                At 50 %
              </Button>
            )}
          </div>
        </>
      ) : null}
      {session.model ? <ModelLine slug={slug} model={session.model} /> : null}
    </section>
  );
}

interface ThresholdSliderProps {
  kind: "keep" | "reject";
  label: string;
  value: number;
  /** Candidates on the screen that it is suggested for. */
  count: number;
  onChange: (value: number) => void;
}

function ThresholdSlider({ kind, label, value, count, onChange }: ThresholdSliderProps) {
  const [low, high] = THRESHOLD_RANGES[kind];
  return (
    <label className="threshold">
      <VerdictMark name={kind === "keep" ? "suggestedKeep" : "suggestedReject"} />
      <span className="threshold__label">
        {label} <span className="numeric">{percent(value)}</span>
      </span>
      <input
        type="range"
        min={low}
        max={high}
        step={0.01}
        value={value}
        onChange={(event) => onChange(event.currentTarget.valueAsNumber)}
      />
      <span className="threshold__count numeric" title="On the screen">
        {formatCount(count)}
      </span>
    </label>
  );
}

function ModelLine({ slug, model }: { slug: string; model: NonNullable<SuggestionSession["model"]> }) {
  return (
    <p className="suggestion-model">
      <Icon name="info" size={14} />
      <span>
        {model.id === null
          ? "By the general model; nothing is learnt here yet."
          : `Model ${model.id}, learnt from ${formatQuantity(model.decisions, "decision")} on ${formatQuantity(model.images, "image")}.`}{" "}
        <Link to={`/datasets/${slug}/suggestions`}>How good it is</Link>
      </span>
    </p>
  );
}

function acceptText({ keep, reject }: { keep: number; reject: number }): string {
  if (keep + reject === 0) return "Nothing to accept";
  if (reject === 0) return `Keep ${formatCount(keep)}`;
  if (keep === 0) return `Reject ${formatCount(reject)}`;
  return `Keep ${formatCount(keep)}, reject ${formatCount(reject)}`;
}

function percent(share: number): string {
  return `${Math.round(100 * share)} %`;
}
