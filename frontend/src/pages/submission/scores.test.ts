import { expect, it } from "vitest";
import type { Score } from "../../api/board_types";
import { currentScores, currentTotals, headline } from "./scores";

function score(protocol: string, split_version: number, done_at: string, key: string, value: number): Score {
  return {
    protocol,
    protocol_version: "1",
    scorer_version: "1",
    split_version,
    totals: { [key]: { value, low: null, high: null } },
    done_at,
  };
}

const OLD = score("clearlines-v2", 1, "2026-05-01T00:00:00Z", "f1", 0.4);
const NEW = score("clearlines-v2", 2, "2026-05-02T00:00:00Z", "f1", 0.5);
const OFFICIAL = score("official-v1", 2, "2026-05-02T00:00:00Z", "official_f1", 1.2);

it("lets the newest score of each protocol stand, and keeps the others", () => {
  const { current, older } = currentScores([OLD, OFFICIAL, NEW]);
  expect(new Set(current)).toEqual(new Set([NEW, OFFICIAL]));
  expect(older).toEqual([OLD]);
});

it("puts the metrics of all protocols together", () => {
  const totals = currentTotals([OLD, NEW, OFFICIAL]);
  expect(totals.f1?.value).toBe(0.5);
  expect(totals.official_f1?.value).toBe(1.2);
  expect(currentTotals([])).toEqual({});
});

it("knows a score by its protocol's F1", () => {
  expect(headline(OFFICIAL)?.value).toBe(1.2);
  expect(headline({ totals: {} })).toBeNull();
});
