import type { Run } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { formatCount, formatDuration } from "../../design/format";
import { Progress } from "../../design/progress";
import { finishedCount } from "../run_text";
import { useRunActions } from "./use_run_actions";

/** The run under way: how far, how long still, and a way to stop it. */
export function RunStrip({ slug, run }: { slug: string; run: Run }) {
  const { cancel } = useRunActions(slug);
  const { maintain } = useRights();
  const over = finishedCount(run);
  const { counts, total, candidates, seconds_left } = run;
  const parts = [`${formatCount(counts.done)} done`];
  parts.push(`${formatCount(total - over)} left`);
  if (candidates > 0) parts.push(`${formatCount(candidates)} candidates`);
  if (typeof seconds_left === "number") parts.push(`about ${formatDuration(seconds_left)}`);
  return (
    <section className="run-strip card" aria-label="Pre-labelling">
      <div className="run-strip__text">
        <strong>{run.status === "queued" ? "Waiting to pre-label" : "Pre-labelling"}</strong>
        <span className="muted numeric">{parts.join(" · ")}</span>
      </div>
      {/* Read aloud in steps, not with each image. */}
      <span className="visually-hidden" aria-live="polite">
        {Math.floor((10 * over) / Math.max(1, total)) * 10} % pre-labelled
      </span>
      {maintain ? (
        <Button small icon="stop" onClick={() => cancel(run.id)}>
          Cancel
        </Button>
      ) : null}
      <Progress label="Pre-labelling" value={over} total={total} />
    </section>
  );
}
