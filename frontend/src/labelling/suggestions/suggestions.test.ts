import { describe, expect, it } from "vitest";
import { reasonPhrase } from "./feature_words";
import {
  byCandidate,
  countSuggested,
  describeAccepted,
  NOT_SUGGESTING,
  type Suggestion,
  sameSuggesting,
  suggestedAt,
  verdictFor,
} from "./suggestions";

const thresholds = { keep: 0.8, reject: 0.2 };

function suggestion(id: number, probability: number): Suggestion {
  return { id, probability, family: -1, value: 0.5, lens: 0.1, for: [], against: [] };
}

describe("what a probability suggests", () => {
  it("is to keep from one threshold on, and to reject below the other", () => {
    expect([1, 0.8, 0.79, 0.2, 0.19].map((p) => verdictFor(p, thresholds))).toEqual([
      "keep",
      "keep",
      null,
      null,
      "reject",
    ]);
  });

  it("leaves nothing to a person where the thresholds meet", () => {
    const both = { keep: 0.5, reject: 0.5 };
    expect(verdictFor(0.5, both)).toBe("keep");
    expect(verdictFor(0.4999, both)).toBe("reject");
  });
});

describe("suggestions of an image", () => {
  const of = byCandidate([{ id: 7 }, { id: 8 }, { id: 9 }], {
    segments: [suggestion(9, 0.1), suggestion(7, 0.9), suggestion(4, 0.9)],
  });
  const suggesting = { of, thresholds, shown: true };

  it("find their candidates, whatever their order", () => {
    expect(of.map((each) => each?.id ?? null)).toEqual([7, null, 9]);
    expect([0, 1, 2].map((index) => suggestedAt(suggesting, index))).toEqual(["keep", null, "reject"]);
  });

  it("are counted for some candidates", () => {
    expect(countSuggested(suggesting, [0, 1, 2])).toEqual({ keep: 1, reject: 1, left: 1 });
    expect(countSuggested(suggesting, [1])).toEqual({ keep: 0, reject: 0, left: 1 });
  });

  it("say nothing where they are hidden, or not there yet", () => {
    expect(suggestedAt({ ...suggesting, shown: false }, 0)).toBeNull();
    expect(suggestedAt(NOT_SUGGESTING, 0)).toBeNull();
  });
});

it("tells what was accepted", () => {
  expect(describeAccepted({ keep: 42, reject: 1_101 })).toBe("42 kept, 1,101 rejected by suggestion");
  expect(describeAccepted({ keep: 0, reject: 3 })).toBe("3 rejected by suggestion");
});

it("says each reason once, and an unknown one by its name", () => {
  expect(reasonPhrase(["residual", "straightness", "contrast", "new"])).toBe("straightness, contrast, new");
  expect(reasonPhrase(["residual", "straightness", "contrast"], 1)).toBe("straightness");
});

describe("suggestions that come again", () => {
  const of = [suggestion(1, 0.9), null];
  const shown = { of, thresholds, shown: true };

  it("are the same where nothing would look different", () => {
    expect(sameSuggesting(shown, { of: [...of], thresholds: { ...thresholds }, shown: true })).toBe(true);
    expect(sameSuggesting(shown, { ...shown, shown: false })).toBe(false);
    expect(sameSuggesting(shown, { ...shown, thresholds: { keep: 0.7, reject: 0.2 } })).toBe(false);
    expect(sameSuggesting(shown, { ...shown, of: [suggestion(1, 0.9), null] })).toBe(false);
    expect(sameSuggesting(shown, { ...shown, of: of.slice(1) })).toBe(false);
  });
});
