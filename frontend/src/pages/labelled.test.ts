import { describe, expect, it } from "vitest";
import type { RunSummary } from "../api/types";
import { cameLabelled, imageSegmentsText, labelledText, segmentsText } from "./labelled";

const imported = {
  candidates: 5_570,
  verdicts: { keep: 5_563, reject: 0, ambiguous: 7, undecided: 0 },
  latest_run: null,
};
const RUN: RunSummary = {
  id: 1,
  status: "done",
  counts: { queued: 0, running: 0, done: 3, failed: 0, cancelled: 0 },
  total: 3,
  created_at: "2026-03-01T10:00:00Z",
  finished_at: "2026-03-01T10:05:00Z",
};

describe("an image that came with its labels", () => {
  it("has labels until a run proposes candidates or a verdict is taken back", () => {
    const image = { ...imported, prelabel: "none" } as const;
    expect(imageSegmentsText(image)).toBe("5,563 labels");
    expect(imageSegmentsText({ ...image, prelabel: "done" })).toBe("5,570 candidates");
    const verdicts = { ...image.verdicts, undecided: 1 };
    expect(imageSegmentsText({ ...image, verdicts })).toBe("5,570 candidates");
  });
});

describe("a dataset that was imported with its labels", () => {
  it("has labels and no candidates", () => {
    expect(cameLabelled(imported)).toBe(true);
    expect(segmentsText(imported)).toBe("5,563 labels");
  });

  it("says how many of its images are labelled", () => {
    expect(labelledText({ images: 100, prelabelled: 3 })).toBe("3 of 100 images labelled");
    expect(labelledText({ images: 100, prelabelled: 100 })).toBe("Labelled");
  });

  it("isn't one that was pre-labelled, even when all of it is judged", () => {
    expect(segmentsText({ ...imported, latest_run: RUN })).toBe("5,570 candidates");
  });

  it("isn't one where something waits for a verdict, or where there is nothing", () => {
    const verdicts = { ...imported.verdicts, undecided: 1 };
    expect(segmentsText({ ...imported, verdicts })).toBe("5,570 candidates");
    const none = { keep: 0, reject: 0, ambiguous: 0, undecided: 0 };
    expect(cameLabelled({ candidates: 0, verdicts: none, latest_run: null })).toBe(false);
    expect(segmentsText({ candidates: 0, verdicts: none, latest_run: null })).toBeNull();
  });
});
