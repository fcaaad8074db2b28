import { describe, expect, it } from "vitest";
import { changesText, finishedCount, parametersText, runSeconds } from "./run_text";

const none = { carried: 0, kept_unmatched: 0, already_there: 0, retired: 0, reopened: 0, discarded: 0 };

describe("texts of runs", () => {
  it("say what changed, and nothing where nothing did", () => {
    expect(changesText(none)).toBe("");
    expect(changesText({ ...none, carried: 12, kept_unmatched: 3, reopened: 1 })).toBe(
      "12 verdicts carried over, 3 kept without a match, 1 image reopened",
    );
  });

  it("say the parameters that there are", () => {
    expect(
      parametersText({ min_length: 80, operating_point: "recall", camera: "per-image", sigma: 0.5 }),
    ).toBe("recall, at least 80 px, one lens per image");
  });

  it("count what is over, however it went", () => {
    expect(finishedCount({ counts: { queued: 1, running: 2, done: 3, failed: 4, cancelled: 5 } })).toBe(12);
  });

  it("time finished runs alone", () => {
    const started_at = "2026-05-04T09:30:00Z";
    expect(runSeconds({ started_at, finished_at: "2026-05-04T09:31:30Z" })).toBe(90);
    expect(runSeconds({ started_at, finished_at: null })).toBeNull();
  });
});
