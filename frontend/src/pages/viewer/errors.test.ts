import { describe, expect, it } from "vitest";
import { ERROR_ORDERS, errorSequence } from "./errors";
import { matched } from "./test_images";

const image = matched(
  [
    { row: [300, 400, 20], outcome: "miss" },
    { row: [0, 90, 20], outcome: "hit" },
    { row: [0, 200, 400], outcome: "miss" },
  ],
  [
    { row: [0, 90, 20], outcome: "hit", best_label: 1, liou: 1, score: 0.1 },
    { row: [100, 250, 22], outcome: "false_alarm", score: 0.3 },
    { row: [0, 190, 400], outcome: "false_alarm", best_label: 2, liou: 0.45, score: 0.9 },
    { row: [0, 90, 30], outcome: "ignored", score: 1 },
  ],
);
const names = (order: (typeof ERROR_ORDERS)[number]) =>
  errorSequence(image, order).map((index) => image.lines[index]?.name);

describe("the errors", () => {
  it.each(ERROR_ORDERS)("are false positives and misses, by %s too", (order) => {
    expect(names(order).sort()).toEqual(["l0", "l2", "p1", "p2"]);
  });

  it("begin with those of which most px have no counterpart", () => {
    // 150 px of nothing; 200 px with LIoU 0.45 leave 110; 190 px leave 104.5; 100 px of nothing.
    expect(names("worst")).toEqual(["p1", "l2", "p2", "l0"]);
  });

  it("begin with what is nearly right", () => {
    expect(names("near")).toEqual(["l2", "p2", "p1", "l0"]);
  });

  it("begin with the surest false positives; misses have no score", () => {
    expect(names("score")).toEqual(["p2", "p1", "l2", "l0"]);
  });

  it("are read like text", () => {
    expect(names("place")).toEqual(["p1", "l0", "p2", "l2"]);
  });

  it("are none on a perfect image", () => {
    const perfect = matched(
      [{ row: [0, 90, 20], outcome: "hit" }],
      [{ row: [0, 90, 20], outcome: "hit", best_label: 0, liou: 1 }],
    );
    expect(errorSequence(perfect, "place")).toEqual([]);
  });
});
