import { describe, expect, it } from "vitest";
import type { Submission, SubmissionStatus } from "./board_types";
import { type Events, followSubmission, parseSubmission } from "./follow_submission";

const at = (status: SubmissionStatus) => ({ id: 7, status }) as Submission;

/** A stream that a test speaks through, a server that it answers for, and a clock that it moves. */
function setUp() {
  const listeners: Record<string, (event: { data?: unknown }) => void> = {};
  const seen: SubmissionStatus[] = [];
  const waiting: { run: () => void; milliseconds: number }[] = [];
  const answers: (Submission | Error)[] = [];
  let closed = 0;
  const events: Events = {
    addEventListener: (name, listener) => {
      listeners[name] = listener;
    },
    close: () => {
      closed += 1;
    },
  };
  const stop = followSubmission({
    connect: () => events,
    ask: async () => {
      const answer = answers.shift();
      if (answer === undefined || answer instanceof Error) throw answer ?? new Error("no answer prepared");
      return answer;
    },
    later: (run, milliseconds) => {
      const entry = { run, milliseconds };
      waiting.push(entry);
      return () => void waiting.splice(waiting.indexOf(entry), 1);
    },
    onChange: ({ status }) => seen.push(status),
  });
  const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
  return {
    seen,
    answers,
    waiting,
    stop,
    settle,
    say: (data: unknown) => listeners.submission?.({ data }),
    fail: () => listeners.error?.({}),
    closed: () => closed > 0,
  };
}

describe("following a submission", () => {
  it("passes on what the stream says and closes it at a final state", () => {
    const following = setUp();
    following.say(JSON.stringify(at("queued")));
    following.say(JSON.stringify(at("scoring")));
    expect(following.closed()).toBe(false);
    following.say(JSON.stringify(at("scored")));
    expect(following.seen).toEqual(["queued", "scoring", "scored"]);
    expect(following.closed()).toBe(true);
  });

  it("asks instead once the stream fails, until a final state", async () => {
    const following = setUp();
    following.answers.push(at("scoring"), new Error("gone"), at("failed"));
    following.fail();
    await following.settle();
    expect(following.seen).toEqual(["scoring"]);
    const usual = following.waiting.shift();
    usual?.run();
    await following.settle();
    const patient = following.waiting.shift();
    expect(patient?.milliseconds).toBeGreaterThan(usual?.milliseconds ?? 0);
    patient?.run();
    await following.settle();
    expect(following.seen).toEqual(["scoring", "failed"]);
    expect(following.waiting).toEqual([]);
  });

  it("says nothing after it was stopped", async () => {
    const following = setUp();
    following.answers.push(at("queued"));
    following.fail();
    await following.settle();
    following.stop();
    expect(following.waiting).toEqual([]);
    following.say(JSON.stringify(at("scored")));
    expect(following.seen).toEqual(["queued"]);
  });

  it("takes no event for a submission that is none", () => {
    for (const data of ["", "{", "null", "[]", '{"id": 1}', undefined, 7]) {
      expect(parseSubmission(data)).toBeNull();
    }
    expect(parseSubmission('{"id": 1, "status": "queued"}')?.status).toBe("queued");
  });
});
