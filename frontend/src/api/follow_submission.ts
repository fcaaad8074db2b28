/** Follows a submission until nothing about it changes any more: by server-sent events, or by asking where they fail. */

import type { Submission, SubmissionStatus } from "./board_types";

const FINAL: readonly SubmissionStatus[] = ["scored", "invalid", "failed", "withdrawn"];
const ASK_MS = 1_500;
const ASK_AFTER_FAILURE_MS = 5_000;

export function isFinal({ status }: Pick<Submission, "status">): boolean {
  return FINAL.includes(status);
}

/** The part of the browser's EventSource that is used here. */
export interface Events {
  addEventListener(name: "submission" | "error", listener: (event: { data?: unknown }) => void): void;
  close(): void;
}

export interface FollowOptions {
  connect: () => Events;
  ask: () => Promise<Submission>;
  /** Runs something later, and returns what prevents it. */
  later: (run: () => void, milliseconds: number) => () => void;
  onChange: (submission: Submission) => void;
}

/** Returns what stops it. */
export function followSubmission({ connect, ask, later, onChange }: FollowOptions): () => void {
  let stopped = false;
  let cancelLater = () => {};

  const take = (submission: Submission) => {
    onChange(submission);
    if (isFinal(submission)) stop();
  };
  const askOn = async () => {
    let wait = ASK_MS;
    try {
      const submission = await ask();
      if (!stopped) take(submission);
    } catch {
      wait = ASK_AFTER_FAILURE_MS;
    }
    if (!stopped) cancelLater = later(() => void askOn(), wait);
  };

  const events = connect();
  events.addEventListener("submission", ({ data }) => {
    const submission = stopped ? null : parseSubmission(data);
    if (submission !== null) take(submission);
  });
  events.addEventListener("error", () => {
    // The browser would connect again by itself, but not through a proxy that holds streams back: asking always works.
    events.close();
    if (!stopped) void askOn();
  });

  function stop() {
    stopped = true;
    cancelLater();
    events.close();
  }
  return stop;
}

/** The submission in an event's data; null where it holds none. */
export function parseSubmission(data: unknown): Submission | null {
  if (typeof data !== "string") return null;
  try {
    const value: unknown = JSON.parse(data);
    const known = typeof value === "object" && value !== null && "id" in value && "status" in value;
    return known ? (value as Submission) : null;
  } catch {
    return null;
  }
}
