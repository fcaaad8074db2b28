import type { ReactNode } from "react";
import type { PrelabelStatus, ReviewStatus } from "../api/types";
import { Icon, type IconName } from "./icons";

export type BadgeTone =
  | "neutral"
  | "accent"
  | "success"
  | "warning"
  | "danger"
  | "keep"
  | "reject"
  | "ambiguous"
  | "undecided";

interface BadgeProps {
  tone?: BadgeTone;
  icon?: IconName | undefined;
  children: ReactNode;
}

export function Badge({ tone = "neutral", icon, children }: BadgeProps) {
  return (
    <span className={`badge badge--${tone}`}>
      {icon ? <Icon name={icon} size={12} /> : null}
      {children}
    </span>
  );
}

const REVIEW: Record<ReviewStatus, { tone: BadgeTone; icon: IconName; text: string }> = {
  open: { tone: "neutral", icon: "circle", text: "Open" },
  done: { tone: "success", icon: "check", text: "Done" },
  discarded: { tone: "warning", icon: "cross", text: "Discarded" },
};

const PRELABEL: Record<PrelabelStatus, { tone: BadgeTone; icon: IconName; text: string }> = {
  none: { tone: "neutral", icon: "circle", text: "Not pre-labelled" },
  queued: { tone: "accent", icon: "more", text: "Queued" },
  running: { tone: "accent", icon: "play", text: "Running" },
  done: { tone: "neutral", icon: "lines", text: "Pre-labelled" },
  failed: { tone: "danger", icon: "warning", text: "Failed" },
  cancelled: { tone: "neutral", icon: "stop", text: "Cancelled" },
};

export function ReviewBadge({ status }: { status: ReviewStatus }) {
  const { tone, icon, text } = REVIEW[status];
  return (
    <Badge tone={tone} icon={icon}>
      {text}
    </Badge>
  );
}

export function PrelabelBadge({ status }: { status: PrelabelStatus }) {
  const { tone, icon, text } = PRELABEL[status];
  return (
    <Badge tone={tone} icon={icon}>
      {text}
    </Badge>
  );
}
