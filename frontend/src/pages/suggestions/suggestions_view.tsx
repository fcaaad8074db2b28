import { useMutation, useQueryClient } from "@tanstack/react-query";
import { trainSuggestions } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { keys } from "../../api/queries";
import type { DatasetSuggestions } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { formatCount, formatDate, formatQuantity, sentence } from "../../design/format";
import { Progress } from "../../design/progress";
import { EmptyState } from "../../design/states";
import { toast } from "../../design/toast";
import { latestSaving } from "./gain";
import { GainChart } from "./gain_chart";
import { ReliabilityDiagram } from "./reliability_diagram";
import { WeightList } from "./weight_list";

interface SuggestionsViewProps {
  slug: string;
  suggestions: DatasetSuggestions;
}

export function SuggestionsView({ slug, suggestions }: SuggestionsViewProps) {
  const { model, calibration, gain, weights } = suggestions;
  return (
    <article className="board-page suggestions-page">
      <header className="board-page__header">
        <div className="board-page__title">
          <h1>Suggestions</h1>
          <p className="muted">{modelText(model)}</p>
        </div>
        <Training slug={slug} suggestions={suggestions} />
      </header>
      {model.id === null ? (
        <EmptyState icon="lines" title="Nothing is learnt here yet">
          Until then the general model suggests, which has seen drawn streets alone. Finish an image, and the
          dataset's own model is learnt from what you kept and rejected.
        </EmptyState>
      ) : null}
      {calibration ? (
        <div className="suggestions-page__pair">
          <section className="section card" aria-labelledby="calibration-title">
            <h2 id="calibration-title">Are probabilities what they say?</h2>
            <ReliabilityDiagram bins={calibration.bins} />
          </section>
          <Quality suggestions={suggestions} calibration={calibration} />
        </div>
      ) : null}
      {gain.length > 0 ? (
        <section className="section card" aria-labelledby="gain-title">
          <div className="section__header">
            <h2 id="gain-title">What suggestions spare</h2>
            <p className="muted">
              Each image judged by a model of the images before it, at the thresholds above
            </p>
          </div>
          <GainChart gain={gain} />
        </section>
      ) : null}
      <section className="section card" aria-labelledby="weights-title">
        <div className="section__header">
          <h2 id="weights-title">What it looks at</h2>
          <p className="muted">
            Log odds that a feature adds on average; to the left, more of it speaks against
          </p>
        </div>
        <WeightList weights={weights} />
      </section>
    </article>
  );
}

/** When the next model comes, and the button that doesn't wait for it. */
function Training({ slug, suggestions }: SuggestionsViewProps) {
  const { training } = suggestions;
  const { label: judges } = useRights();
  const queryClient = useQueryClient();
  const train = useMutation({
    mutationFn: () => trainSuggestions(slug),
    onSuccess: () => queryClient.invalidateQueries({ queryKey: keys.datasetSuggestions(slug) }),
    onError: (error) => toast({ key: "train", tone: "danger", message: sentence(asProblem(error).message) }),
  });
  const enough = training.decisions >= training.least;
  return (
    <div className="training">
      <div className="training__row">
        <span className="muted numeric">
          {formatCount(training.decisions)} of {formatCount(training.wanted)} decisions for the next one
        </span>
        {judges ? (
          <Button
            icon="play"
            busy={train.isPending || training.asked}
            disabled={!enough}
            title={enough ? undefined : `It takes ${training.least} decisions on images that are all decided`}
            onClick={() => train.mutate()}
          >
            {training.asked ? "Learning" : "Learn now"}
          </Button>
        ) : null}
      </div>
      <Progress value={training.decisions} total={training.wanted} label="Decisions for the next model" />
      {training.error ? (
        <p className="training__error">The latest training failed: {sentence(training.error.message)}</p>
      ) : null}
    </div>
  );
}

function Quality({
  suggestions,
  calibration,
}: {
  suggestions: DatasetSuggestions;
  calibration: NonNullable<DatasetSuggestions["calibration"]>;
}) {
  const saving = latestSaving(suggestions.gain);
  const { thresholds } = suggestions;
  const facts: [string, string, string][] = [
    [
      "Keep from",
      percent(thresholds.keep),
      "Recommended: of what is accepted, one in twenty is wrong at most",
    ],
    [
      "Reject below",
      percent(thresholds.reject),
      "Recommended: of what is accepted, one in twenty is wrong at most",
    ],
    ["Wrong at 50 %", percent(calibration.error_rate), "Where every suggestion is taken"],
    [
      "Wrong without a model",
      percent(calibration.base_error_rate),
      "Where all get the more frequent verdict",
    ],
    ["Calibration error", percent(calibration.ece), "Mean distance of probability and share kept"],
    ["Brier score", calibration.brier.toFixed(3), "Mean squared error of the probability; 0.25 is guessing"],
    ["Log loss", calibration.log_loss.toFixed(3), "Nats; 0.693 is guessing"],
  ];
  return (
    <section className="section card" aria-labelledby="quality-title">
      <h2 id="quality-title">On images that it hadn't seen</h2>
      {saving ? (
        <p className="suggestions-page__saving">
          <strong className="numeric">{percent(saving.share)}</strong>
          <span className="muted">
            of the keys spared on the latest {formatQuantity(saving.images, "image")}:{" "}
            {formatCount(saving.keys)} instead of {formatCount(saving.byHand)}
          </span>
        </p>
      ) : null}
      <dl className="suggestions-page__facts">
        {facts.map(([name, value, hint]) => (
          <div key={name} title={hint}>
            <dt>{name}</dt>
            <dd className="numeric">{value}</dd>
          </div>
        ))}
      </dl>
      <p className="muted suggestions-page__note">
        Measured on {formatQuantity(calibration.count, "candidate")} of{" "}
        {formatQuantity(calibration.images, "image")}, each time by a model that was learnt without them.
      </p>
    </section>
  );
}

function modelText({ id, decisions, images, created_at }: DatasetSuggestions["model"]): string {
  if (id === null) return "The general model, learnt from drawn streets";
  const when = created_at === null ? "" : ` · ${formatDate(created_at)}`;
  return `Model ${id}, learnt from ${formatQuantity(decisions, "decision")} on ${formatQuantity(images, "image")}${when}`;
}

function percent(share: number): string {
  return `${Math.round(100 * share)} %`;
}
