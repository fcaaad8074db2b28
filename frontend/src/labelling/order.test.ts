import { describe, expect, it } from "vitest";
import { nextInSequence, reviewSequence } from "./order";
import { candidate } from "./test_candidates";

describe("order of review", () => {
  it("reads rows from left to right", () => {
    const candidates = [
      candidate(1, { box: [500, 10, 510, 20] }),
      candidate(2, { box: [0, 500, 10, 510] }),
      candidate(3, { box: [0, 40, 10, 50] }),
    ];
    expect(reviewSequence(candidates, "position", 600)).toEqual([2, 0, 1]);
  });

  it("puts the best score, or the longest, first", () => {
    const candidates = [
      candidate(1, { score: 0.2, length: 30 }),
      candidate(2, { score: null, length: 90 }),
      candidate(3, { score: 0.9, length: 60 }),
    ];
    expect(reviewSequence(candidates, "score", 100)).toEqual([2, 0, 1]);
    expect(reviewSequence(candidates, "length", 100)).toEqual([1, 2, 0]);
  });

  it("keeps the given order among equals", () => {
    const equal = [candidate(1), candidate(2), candidate(3)];
    expect(reviewSequence(equal, "length", 100)).toEqual([0, 1, 2]);
  });
});

describe("next in a sequence", () => {
  const sequence = [4, 2, 7, 5];
  const all = () => true;

  it("goes around in both directions", () => {
    expect(nextInSequence(sequence, 5, 1, all)).toBe(4);
    expect(nextInSequence(sequence, 4, -1, all)).toBe(5);
  });

  it("starts at an end where nothing is selected", () => {
    expect(nextInSequence(sequence, null, 1, all)).toBe(4);
    expect(nextInSequence(sequence, null, -1, all)).toBe(5);
  });

  it("passes over what isn't accepted, and never gives the start", () => {
    expect(nextInSequence(sequence, 4, 1, (index) => index === 5)).toBe(5);
    expect(nextInSequence(sequence, 4, 1, (index) => index === 4)).toBeNull();
    expect(nextInSequence([], null, 1, all)).toBeNull();
  });
});
