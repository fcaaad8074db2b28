import { describe, expect, it } from "vitest";
import { nextInSequence, orderAfter, REVIEW_ORDERS, readingRows, reviewSequence } from "./order";
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

  it("doesn't tear a row apart where its middles differ by a little", () => {
    const candidates = [
      candidate(1, { box: [900, 100, 905, 500.4] }),
      candidate(2, { box: [100, 100, 105, 499.6] }),
      candidate(3, { box: [500, 100, 505, 500] }),
    ];
    expect(reviewSequence(candidates, "position", 600)).toEqual([1, 2, 0]);
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

  it("puts what is most worth a look first, and what nobody knows last, by its place", () => {
    const candidates = [candidate(1), candidate(2), candidate(3), candidate(4)];
    const worth = [null, { value: 0.2, lens: 0.7 }, { value: 0.9, lens: 0.1 }, null];
    expect(reviewSequence(candidates, "value", 100, worth)).toEqual([2, 1, 0, 3]);
    expect(reviewSequence(candidates, "lens", 100, worth)).toEqual([1, 2, 0, 3]);
    expect(reviewSequence(candidates, "lens", 100)).toEqual(reviewSequence(candidates, "position", 100));
  });

  it("goes round", () => {
    const visited = REVIEW_ORDERS.map((_, step) => {
      let order = REVIEW_ORDERS[0] as (typeof REVIEW_ORDERS)[number];
      for (let i = 0; i < step; i++) order = orderAfter(order);
      return order;
    });
    expect(visited).toEqual([...REVIEW_ORDERS]);
    expect(orderAfter(visited.at(-1) ?? "lens")).toBe(REVIEW_ORDERS[0]);
  });

  it("keeps the given order among equals", () => {
    const equal = [candidate(1), candidate(2), candidate(3)];
    expect(reviewSequence(equal, "length", 100)).toEqual([0, 1, 2]);
  });
});

describe("rows of reading", () => {
  it("are cut at the widest gap in their lower half", () => {
    expect(readingRows([0, 30, 55, 60, 90, 95, 105], 100)).toEqual([0, 0, 0, 0, 1, 1, 1]);
  });

  it("are at most as tall as allowed", () => {
    const heights = Array.from({ length: 500 }, (_, index) => 3.7 * index);
    const rows = readingRows(heights, 100);
    for (const row of new Set(rows)) {
      const members = heights.filter((_, index) => rows[index] === row);
      expect(Math.max(...members) - Math.min(...members)).toBeLessThanOrEqual(100);
    }
    expect(new Set(rows).size).toBeLessThan(40);
  });

  it("belong to each height, in whatever order they come", () => {
    expect(readingRows([300, 0, 301, 1], 100)).toEqual([1, 0, 1, 0]);
    expect(readingRows([], 100)).toEqual([]);
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
