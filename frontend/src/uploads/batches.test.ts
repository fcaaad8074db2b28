import { describe, expect, it } from "vitest";
import { makeBatches } from "./batches";

const limits = { files: 3, bytes: 100, wholeBytes: 1_000 };
const files = (...entries: [string, number][]) => entries.map(([path, size]) => ({ path, size }));
const paths = (batches: { path: string }[][]) => batches.map((batch) => batch.map((file) => file.path));

describe("makeBatches", () => {
  it("cuts by number and keeps the order", () => {
    const batches = makeBatches(files(["a.png", 1], ["b.png", 1], ["c.png", 1], ["d.png", 1]), limits);
    expect(paths(batches)).toEqual([["a.png", "b.png", "c.png"], ["d.png"]]);
  });

  it("cuts by size, and sends a file alone that is too large for any batch", () => {
    const batches = makeBatches(files(["a.png", 60], ["b.png", 60], ["c.png", 500], ["d.png", 1]), limits);
    expect(paths(batches)).toEqual([["a.png"], ["b.png"], ["c.png"], ["d.png"]]);
  });

  it("takes a batch of exactly the limits", () => {
    expect(paths(makeBatches(files(["a.png", 50], ["b.png", 50]), limits))).toEqual([["a.png", "b.png"]]);
  });

  it("sends each zip alone", () => {
    const batches = makeBatches(files(["x.zip", 1], ["a.png", 1], ["Y.ZIP", 1]), limits);
    expect(paths(batches)).toEqual([["a.png"], ["x.zip"], ["Y.ZIP"]]);
  });

  it("keeps an image and its labels together", () => {
    const label = "york/labels/a_edge_segments_filtered.npy";
    const batches = makeBatches(
      files(["york/images/x.png", 1], ["york/images/y.png", 1], ["york/images/a.png", 1], [label, 1]),
      limits,
    );
    expect(paths(batches)).toEqual([
      ["york/images/x.png", "york/images/y.png"],
      ["york/images/a.png", label],
    ]);
  });

  it("sends files with a table as one dataset", () => {
    const dataset = files(["d/images/1.png", 90], ["d/images/2.png", 90], ["d/images.csv", 1]);
    expect(makeBatches(dataset, limits)).toHaveLength(1);
    expect(makeBatches(dataset, { ...limits, wholeBytes: 150 })).toHaveLength(2);
  });

  it("makes nothing of nothing", () => {
    expect(makeBatches([], limits)).toEqual([]);
  });
});
