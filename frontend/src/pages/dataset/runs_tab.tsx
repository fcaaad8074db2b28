import type { UseQueryResult } from "@tanstack/react-query";
import type { Run } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button, IconButton } from "../../design/button";
import { formatCount, formatDate, formatDuration, formatQuantity } from "../../design/format";
import { EmptyState, ErrorState } from "../../design/states";
import { RunBadge } from "../run_state";
import { changesText, isActive, parametersText, runSeconds } from "../run_text";
import { RunFailures } from "./run_failures";
import { useRunActions } from "./use_run_actions";
import "./runs.css";

interface RunsTabProps {
  slug: string;
  runs: UseQueryResult<Run[]>;
  onPrelabel: () => void;
}

/** The history of runs: with which parameters, how long, what came of it. */
export function RunsTab({ slug, runs, onPrelabel }: RunsTabProps) {
  const { maintain } = useRights();
  if (runs.isError) return <ErrorState error={runs.error} onRetry={() => runs.refetch()} />;
  if (!runs.data)
    return <div className="skeleton runs-tab__loading" role="status" aria-label="Loading runs" />;
  if (runs.data.length === 0) {
    return (
      <EmptyState
        icon="play"
        title="No runs yet"
        actions={
          maintain ? (
            <Button tone="primary" icon="play" onClick={onPrelabel}>
              Pre-label
            </Button>
          ) : null
        }
      >
        A run finds candidates in all images and estimates the lens of each camera.
      </EmptyState>
    );
  }
  return (
    <ol className="runs-tab">
      {runs.data.map((run) => (
        <RunCard key={run.id} slug={slug} run={run} />
      ))}
    </ol>
  );
}

function RunCard({ slug, run }: { slug: string; run: Run }) {
  const { maintain } = useRights();
  const { counts } = run;
  const active = isActive(run);
  return (
    <li className="run-card card">
      <header className="run-card__header">
        <h2 className="numeric">Run {run.id}</h2>
        <RunBadge run={run} />
        <time className="muted numeric" dateTime={run.created_at}>
          {formatDate(run.created_at)}
        </time>
        {maintain ? <RunActions slug={slug} run={run} /> : null}
      </header>
      <dl className="run-card__facts numeric">
        <Fact name="Images" value={imagesText(run)} />
        <Fact name="Candidates" value={formatCount(run.candidates)} />
        <Fact name="Time" value={timeText(run)} />
        <Fact name="Parameters" value={parametersText(run.parameters)} />
        <Fact
          name="What changed"
          value={changesText(run.changes) || (active ? "Not known yet" : "Nothing was there before")}
        />
      </dl>
      {run.error ? <p className="field__error">{run.error.message}</p> : null}
      {counts.failed > 0 ? <RunFailures slug={slug} run={run} /> : null}
    </li>
  );
}

function RunActions({ slug, run }: { slug: string; run: Run }) {
  const { retry, cancel, remove } = useRunActions(slug);
  const { counts } = run;
  const active = isActive(run);
  return (
    <div className="run-card__actions">
      {active ? (
        <Button small icon="stop" onClick={() => cancel(run.id)}>
          Cancel
        </Button>
      ) : null}
      {counts.failed > 0 && !active ? (
        <Button small icon="retry" onClick={() => retry(run.id)}>
          Retry {formatQuantity(counts.failed, "image")}
        </Button>
      ) : null}
      {active ? null : (
        <IconButton small side="end" icon="trash" label="Delete this run" onClick={() => remove(run.id)} />
      )}
    </div>
  );
}

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value}</dd>
    </div>
  );
}

function imagesText({ counts, total }: Run): string {
  const parts = [`${formatCount(counts.done)} of ${formatCount(total)} done`];
  if (counts.failed > 0) parts.push(`${formatCount(counts.failed)} failed`);
  if (counts.cancelled > 0) parts.push(`${formatCount(counts.cancelled)} cancelled`);
  return parts.join(", ");
}

function timeText(run: Run): string {
  const seconds = runSeconds(run);
  if (seconds !== null) {
    const each = run.counts.done > 0 ? `, ${(seconds / run.counts.done).toFixed(1)} s per image` : "";
    return `${formatDuration(seconds)}${each}`;
  }
  return typeof run.seconds_left === "number"
    ? `about ${formatDuration(run.seconds_left)} left`
    : "Not known yet";
}
