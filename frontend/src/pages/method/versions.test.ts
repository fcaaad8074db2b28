import { expect, it } from "vitest";
import type { Submission } from "../../api/board_types";
import { bySplit, versionPoints } from "./versions";

function submission(id: number, slug: string, day: number, f1: number | null): Submission {
  return {
    id,
    label: null,
    status: f1 === null ? "failed" : "scored",
    split: { slug, name: slug, visibility: "open" },
    created_at: `2026-05-0${day}T10:00:00Z`,
    scores:
      f1 === null
        ? []
        : [{ protocol: "clearlines-v2", split_version: 1, totals: { f1: { value: f1, low: 0, high: 1 } } }],
  } as unknown as Submission;
}

const ALL = [submission(1, "kitti", 1, 0.4), submission(2, "york", 3, 0.5), submission(3, "kitti", 2, null)];

it("puts the split of the newest submission first, and the newest of a split first", () => {
  expect(bySplit(ALL).map(({ split, submissions }) => [split.slug, submissions.map(({ id }) => id)])).toEqual(
    [
      ["york", [2]],
      ["kitti", [3, 1]],
    ],
  );
});

it("draws the scored ones in the order of time", () => {
  const points = versionPoints([submission(9, "kitti", 4, 0.6), ...ALL]);
  expect(points.map(({ id }) => id)).toEqual([1, 2, 9]);
  expect(points[0]).toMatchObject({ label: "Submission 1", value: 0.4, low: 0, high: 1 });
});
