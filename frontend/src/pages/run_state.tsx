import type { RunSummary } from "../api/types";
import { Badge, type BadgeTone } from "../design/badge";
import { formatCount, formatQuantity } from "../design/format";
import type { IconName } from "../design/icons";
import { Progress } from "../design/progress";
import { finishedCount, isActive } from "./run_text";

const ENDED: Record<"done" | "failed" | "cancelled", { tone: BadgeTone; icon: IconName; text: string }> = {
  done: { tone: "success", icon: "check", text: "Pre-labelled" },
  failed: { tone: "danger", icon: "warning", text: "Run failed" },
  cancelled: { tone: "neutral", icon: "stop", text: "Run cancelled" },
};

/** A run in one line: a bar while it goes on, a badge when it is over. */
export function RunState({ run }: { run: RunSummary }) {
  if (isActive(run)) {
    return (
      <div className="run-state">
        <Progress label="Pre-labelling" value={finishedCount(run)} total={run.total} />
        <span className="numeric muted">
          {run.status === "queued"
            ? "Waiting to pre-label"
            : `Pre-labelling ${formatCount(finishedCount(run))} of ${formatCount(run.total)}`}
        </span>
      </div>
    );
  }
  return <RunBadge run={run} />;
}

export function RunBadge({ run }: { run: RunSummary }) {
  if (isActive(run)) {
    return (
      <Badge tone="accent" icon={run.status === "queued" ? "clock" : "play"}>
        {run.status === "queued" ? "Queued" : "Running"}
      </Badge>
    );
  }
  if (run.status === "done" && run.counts.failed > 0) {
    return (
      <Badge tone="warning" icon="warning">
        {formatQuantity(run.counts.failed, "image")} failed
      </Badge>
    );
  }
  const { tone, icon, text } = ENDED[run.status as keyof typeof ENDED];
  return (
    <Badge tone={tone} icon={icon}>
      {text}
    </Badge>
  );
}
