/** What is said of pre-labelling runs. */

import type { Run, RunChanges, RunSummary } from "../api/types";
import { formatCount, formatQuantity } from "../design/format";

export function isActive(run: Pick<RunSummary, "status">): boolean {
  return run.status === "queued" || run.status === "running";
}

/** Images that the run is through with, however it went. */
export function finishedCount({ counts }: Pick<RunSummary, "counts">): number {
  return counts.done + counts.failed + counts.cancelled;
}

/** "12 verdicts carried over, 3 kept without a match"; empty where nothing was there before. */
export function changesText(changes: RunChanges): string {
  const parts: string[] = [];
  if (changes.carried > 0) parts.push(`${formatQuantity(changes.carried, "verdict")} carried over`);
  if (changes.kept_unmatched > 0) parts.push(`${formatCount(changes.kept_unmatched)} kept without a match`);
  if (changes.already_there > 0)
    parts.push(`${formatCount(changes.already_there)} covered by labels already`);
  if (changes.retired > 0) parts.push(`${formatQuantity(changes.retired, "older candidate")} replaced`);
  if (changes.discarded > 0) parts.push(`${formatQuantity(changes.discarded, "bent candidate")} discarded`);
  if (changes.reopened > 0) parts.push(`${formatQuantity(changes.reopened, "image")} reopened`);
  return parts.join(", ");
}

/** Seconds that a finished run took; null while it isn't over. */
export function runSeconds(run: Pick<Run, "started_at" | "finished_at">): number | null {
  if (!run.started_at || !run.finished_at) return null;
  return (Date.parse(run.finished_at) - Date.parse(run.started_at)) / 1000;
}

const PARAMETERS: Record<string, (value: unknown) => string> = {
  operating_point: (value) => String(value),
  min_length: (value) => `at least ${value} px`,
  camera: (value) => (value === "joint" ? "one lens per camera" : "one lens per image"),
  discard: (value) => (value ? "bent ones discarded" : "bent ones marked"),
};

/** "balanced, at least 100 px, one lens per camera, bent ones marked". */
export function parametersText(parameters: Run["parameters"]): string {
  return Object.entries(PARAMETERS)
    .flatMap(([name, text]) => (name in parameters ? [text(parameters[name])] : []))
    .join(", ");
}
