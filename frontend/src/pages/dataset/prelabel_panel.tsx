import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { getFacets, type RunRequest, startRun } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { configurationQuery, keys } from "../../api/queries";
import type { Configuration, Dataset } from "../../api/types";
import { Button } from "../../design/button";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { Segmented } from "../../design/segmented";
import { ErrorState } from "../../design/states";
import { imageIds } from "./use_images";
import "./prelabel_panel.css";

const OPERATING_POINTS: Record<string, string> = {
  recall: "Most candidates: misses the fewest lines, more to reject.",
  balanced: "Few misses at a fair number of candidates.",
  precise: "Fewest candidates: quick to judge, misses some lines.",
};

type Scope = "all" | "new" | "selected";
type OperatingPoint = NonNullable<RunRequest["operating_point"]>;

interface PrelabelPanelProps {
  dataset: Dataset;
  selected: number[];
  onClose: () => void;
  onStarted: () => void;
}

/** The parameters of a run, in the page rather than over it. */
export function PrelabelPanel(props: PrelabelPanelProps) {
  const configuration = useQuery(configurationQuery);
  return (
    <section className="prelabel-panel card" aria-label="Pre-label">
      {configuration.data ? (
        <PrelabelForm {...props} configuration={configuration.data} />
      ) : configuration.isError ? (
        <ErrorState error={configuration.error} onRetry={() => configuration.refetch()} />
      ) : (
        <div className="skeleton prelabel-panel__loading" />
      )}
    </section>
  );
}

function PrelabelForm(props: PrelabelPanelProps & { configuration: Configuration }) {
  const { dataset, selected, configuration, onClose, onStarted } = props;
  const { slug, images } = dataset;
  const client = useQueryClient();
  const facets = useQuery({ queryKey: keys.facets(slug), queryFn: () => getFacets(slug) });
  const fresh = facets.data?.prelabel.none ?? 0;
  const defaults = configuration.run_defaults;
  const [scope, setScope] = useState<Scope>(selected.length > 0 ? "selected" : "all");
  const [point, setPoint] = useState(String(defaults.operating_point));
  const [minLength, setMinLength] = useState(String(defaults.min_length));
  const [camera, setCamera] = useState<"joint" | "per-image">(
    defaults.camera === "per-image" ? "per-image" : "joint",
  );
  const [discard, setDiscard] = useState(defaults.discard === true);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const count = { all: images, new: fresh, selected: selected.length }[scope];

  const submit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    try {
      const request: RunRequest = {
        operating_point: point as OperatingPoint,
        min_length: Number(minLength),
        camera,
        discard,
      };
      if (scope === "selected") request.image_ids = selected;
      if (scope === "new") request.image_ids = await imageIds(slug, { prelabel: "none" });
      await startRun(slug, request);
      await client.invalidateQueries({ queryKey: keys.dataset(slug) });
      onStarted();
    } catch (error) {
      setProblem(problemText(error));
      setBusy(false);
    }
  };

  return (
    <form
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key !== "Escape") return;
        event.stopPropagation();
        onClose();
      }}
    >
      <fieldset className="prelabel-panel__points">
        <legend className="field__label">Operating point</legend>
        {configuration.operating_points.map((name) => (
          <label key={name} className="choice-card">
            <input
              type="radio"
              name="operating-point"
              checked={point === name}
              // biome-ignore lint/a11y/noAutofocus: the panel was opened to choose here; Enter starts at once
              autoFocus={point === name}
              onChange={() => setPoint(name)}
            />
            <span>
              <strong>
                {name[0]?.toUpperCase()}
                {name.slice(1)}
              </strong>
              <span className="muted">{OPERATING_POINTS[name]}</span>
            </span>
          </label>
        ))}
      </fieldset>
      <div className="prelabel-panel__fields">
        <label className="field">
          <span className="field__label">Minimum length</span>
          <span className="prelabel-panel__length">
            <input
              className="input numeric"
              type="number"
              min={10}
              max={10_000}
              step="any"
              required
              value={minLength}
              onChange={(event) => setMinLength(event.target.value)}
            />
            <span className="muted">px, end to end</span>
          </span>
        </label>
        <div className="field">
          <span className="field__label">Lens</span>
          <Segmented
            label="Lens"
            name="lens"
            value={camera}
            onChange={setCamera}
            choices={[
              {
                value: "joint",
                label: "One per camera",
                title: "All images of a camera estimate one lens together",
              },
              { value: "per-image", label: "One per image", title: "Each image estimates a lens of its own" },
            ]}
          />
        </div>
        <div className="field">
          <span className="field__label">Images</span>
          <Segmented
            label="Images"
            name="scope"
            value={scope}
            onChange={setScope}
            choices={[
              { value: "all", label: `All ${formatCount(images)}` },
              ...(fresh > 0 && fresh < images
                ? [{ value: "new" as const, label: `Not pre-labelled yet: ${formatCount(fresh)}` }]
                : []),
              ...(selected.length > 0
                ? [{ value: "selected" as const, label: `Selected: ${formatCount(selected.length)}` }]
                : []),
            ]}
          />
        </div>
        <label className="checkbox prelabel-panel__discard">
          <input type="checkbox" checked={discard} onChange={(event) => setDiscard(event.target.checked)} />
          <span>
            Discard candidates that aren't straight
            <span className="muted"> (else they stay, marked)</span>
          </span>
        </label>
      </div>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
      <div className="prelabel-panel__actions">
        <Button type="submit" tone="primary" icon="play" busy={busy} disabled={count === 0}>
          Pre-label {formatQuantity(count, "image")}
        </Button>
        <Button tone="quiet" onClick={onClose}>
          Cancel
        </Button>
        {dataset.candidates > 0 ? (
          <span className="muted">
            Verdicts follow to the new candidates that match; nothing decided is lost.
          </span>
        ) : null}
      </div>
    </form>
  );
}

function problemText(error: unknown): string {
  const { message, expected, hint } = asProblem(error);
  return [message, expected ? `Expected: ${expected}` : null, hint]
    .flatMap((text) => (text ? [sentence(text)] : []))
    .join(" ");
}
