import type { MethodKind, Split, SubmissionStatus, Visibility } from "../api/board_types";
import { Badge, type BadgeTone } from "../design/badge";
import type { IconName } from "../design/icons";
import { deadlineText, deadlineTitle } from "./deadline";

export function VisibilityBadge({ visibility }: { visibility: Visibility }) {
  return visibility === "hidden" ? (
    <Badge tone="warning" icon="lock">
      Hidden labels
    </Badge>
  ) : (
    <Badge icon="eye">Open labels</Badge>
  );
}

export function DeadlineBadge({ split }: { split: Pick<Split, "closes_at" | "closed"> }) {
  const text = deadlineText(split, Date.now());
  if (text === null) return null;
  return (
    <span title={deadlineTitle(split)}>
      <Badge tone={text === "Closed" ? "neutral" : "accent"} icon="clock">
        {text}
      </Badge>
    </span>
  );
}

const KINDS: Record<Exclude<MethodKind, "method">, string> = {
  baseline: "For comparison, put there by this server",
  ceiling: "What a second person reaches on the same images",
};

/** Says of a row that it isn't somebody's entry. */
export function KindBadge({ kind }: { kind: MethodKind }) {
  if (kind === "method") return null;
  return (
    <span title={KINDS[kind]}>
      <Badge tone={kind === "ceiling" ? "ambiguous" : "neutral"}>
        {kind === "ceiling" ? "Ceiling" : "Baseline"}
      </Badge>
    </span>
  );
}

const STATUSES: Record<SubmissionStatus, { tone: BadgeTone; icon: IconName; text: string }> = {
  received: { tone: "accent", icon: "upload", text: "Received" },
  validating: { tone: "accent", icon: "search", text: "Being checked" },
  queued: { tone: "accent", icon: "clock", text: "Queued" },
  scoring: { tone: "accent", icon: "play", text: "Scoring" },
  scored: { tone: "success", icon: "check", text: "Scored" },
  invalid: { tone: "danger", icon: "warning", text: "Invalid" },
  failed: { tone: "danger", icon: "warning", text: "Failed" },
  withdrawn: { tone: "neutral", icon: "undo", text: "Withdrawn" },
};

export function SubmissionBadge({ status }: { status: SubmissionStatus }) {
  const { tone, icon, text } = STATUSES[status];
  return (
    <Badge tone={tone} icon={icon}>
      {text}
    </Badge>
  );
}
