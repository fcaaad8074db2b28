/** The road of a submission, as steps. */

import type { Submission } from "../../api/board_types";
import { formatCount, formatQuantity } from "../../design/format";

export interface Step {
  name: "Uploaded" | "Checked" | "Queued" | "Scored";
  state: "done" | "current" | "ahead" | "failed";
  text: string;
  /** From 0 to 1; null where it isn't known or over. */
  progress: number | null;
}

type Told = Pick<Submission, "status" | "position" | "progress" | "attempts" | "images" | "missing" | "log">;

const REACHED: Record<Submission["status"], number> = {
  received: 1,
  validating: 1,
  queued: 2,
  scoring: 3,
  scored: 4,
  invalid: 1,
  failed: 3,
  withdrawn: 4,
};

export function stepsOf(submission: Told): Step[] {
  const { status, progress, attempts, missing, position } = submission;
  const reached = REACHED[status];
  const broken = status === "invalid" || status === "failed";
  const names = ["Uploaded", "Checked", "Queued", "Scored"] as const;
  const texts = [
    "",
    missing.length > 0 ? `${formatQuantity(missing.length, "image")} without results` : "",
    status === "queued" ? queueText(position) : "",
    status === "scoring" ? scoringText(progress, attempts) : "",
  ];
  return names.map((name, index) => {
    const state = index < reached ? "done" : index > reached ? "ahead" : broken ? "failed" : "current";
    return {
      name,
      state,
      text: texts[index] ?? "",
      progress: name === "Scored" && status === "scoring" ? progress : null,
    };
  });
}

/** "Next", "2 before it"; positions count from 1. */
function queueText(position: number | null): string {
  if (position === null) return "";
  return position <= 1 ? "Next" : `${formatCount(position - 1)} before it`;
}

function scoringText(progress: number, attempts: number): string {
  const share = `${Math.floor(progress * 100)} %`;
  const again = attempts > 1 ? `attempt ${attempts}` : "";
  return [share, again].filter((text) => text !== "").join(", ");
}
