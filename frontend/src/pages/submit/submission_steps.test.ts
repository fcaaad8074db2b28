import { describe, expect, it } from "vitest";
import type { Submission } from "../../api/board_types";
import { stepsOf } from "./submission_steps";

const told = (status: Submission["status"], more: Partial<Submission> = {}) => ({
  status,
  position: null,
  progress: 0,
  attempts: 1,
  images: 10,
  missing: [],
  log: [],
  ...more,
});

const states = (submission: Parameters<typeof stepsOf>[0]) => stepsOf(submission).map(({ state }) => state);

describe("steps of a submission", () => {
  it("follow its state", () => {
    expect(states(told("validating"))).toEqual(["done", "current", "ahead", "ahead"]);
    expect(states(told("queued"))).toEqual(["done", "done", "current", "ahead"]);
    expect(states(told("scoring"))).toEqual(["done", "done", "done", "current"]);
    expect(states(told("scored"))).toEqual(["done", "done", "done", "done"]);
  });

  it("stop where it failed", () => {
    expect(states(told("invalid"))).toEqual(["done", "failed", "ahead", "ahead"]);
    expect(states(told("failed"))).toEqual(["done", "done", "done", "failed"]);
  });

  it("say the place in the queue and how far the scoring is", () => {
    expect(stepsOf(told("queued", { position: 1 }))[2]?.text).toBe("Next");
    expect(stepsOf(told("queued", { position: 3 }))[2]?.text).toBe("2 before it");
    const scoring = stepsOf(told("scoring", { progress: 0.426, attempts: 2 }))[3];
    expect(scoring).toMatchObject({ text: "42 %, attempt 2", progress: 0.426 });
  });

  it("say which images have no results", () => {
    expect(stepsOf(told("queued", { missing: ["a", "b"] }))[1]?.text).toBe("2 images without results");
  });
});
