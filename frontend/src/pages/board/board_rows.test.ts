import { describe, expect, it } from "vitest";
import type { BoardRow } from "../../api/board_types";
import {
  BY_RANK,
  bestRow,
  knownMetrics,
  nextSort,
  rankText,
  readSort,
  sortRows,
  sortText,
  tiedText,
} from "./board_rows";

function row(slug: string, f1: number | null, more: Partial<BoardRow> = {}): BoardRow {
  return {
    rank_low: 1,
    rank_high: 1,
    tied_with: [],
    method: { slug, name: slug.toUpperCase(), kind: "method", code_url: null, paper_url: null },
    submission_id: 1,
    label: null,
    person: null,
    scored_at: null,
    totals: { f1: { value: f1, low: null, high: null } },
    warning: null,
    ...more,
  };
}

const names = (rows: BoardRow[]) => rows.map(({ method }) => method.slug);

describe("order of a board", () => {
  it("is read from the address and written to it", () => {
    for (const text of ["-f1", "offset_mean", "-date", "method"]) {
      expect(sortText(readSort(text))).toBe(text);
    }
    expect(sortText(BY_RANK)).toBeNull();
    expect(readSort("password")).toEqual(BY_RANK);
    expect(readSort(null)).toEqual(BY_RANK);
  });

  it("begins with a column's best and turns round at the second press", () => {
    expect(nextSort(BY_RANK, "f1")).toEqual({ column: "f1", descending: true });
    expect(nextSort(BY_RANK, "offset_mean")).toEqual({ column: "offset_mean", descending: false });
    expect(nextSort({ column: "f1", descending: true }, "f1")).toEqual({ column: "f1", descending: false });
  });

  it("puts rows without a value last in both directions", () => {
    const rows = [row("none", null), row("low", 0.2), row("high", 0.8)];
    expect(names(sortRows(rows, { column: "f1", descending: true }))).toEqual(["high", "low", "none"]);
    expect(names(sortRows(rows, { column: "f1", descending: false }))).toEqual(["low", "high", "none"]);
  });

  it("keeps the order of equals", () => {
    const rows = [row("b", 0.5), row("a", 0.5)];
    expect(names(sortRows(rows, { column: "f1", descending: true }))).toEqual(["b", "a"]);
  });

  it("goes by the best rank, then by F1 and not by the width of the interval", () => {
    const rows = [
      row("unranked", 0.9, { rank_low: null, rank_high: null }),
      row("third", 0.99, { rank_low: 3, rank_high: 3 }),
      row("narrow", 0.781, { rank_low: 1, rank_high: 2 }),
      row("wide", 0.784, { rank_low: 1, rank_high: 3 }),
    ];
    expect(names(sortRows(rows, BY_RANK))).toEqual(["wide", "narrow", "third", "unranked"]);
    expect(names(sortRows(rows, { column: "rank", descending: true }))).toEqual([
      "third",
      "wide",
      "narrow",
      "unranked",
    ]);
  });
});

describe("rows of a board", () => {
  it("say a rank as an interval", () => {
    expect(rankText({ rank_low: 2, rank_high: 2 })).toBe("2");
    expect(rankText({ rank_low: 1, rank_high: 3 })).toBe("1–3");
    expect(rankText({ rank_low: null, rank_high: null })).toBe("–");
  });

  it("name those they are tied with", () => {
    const rows = [row("a", 0.5, { tied_with: ["b", "gone"] }), row("b", 0.5)];
    expect(rows.map((each) => tiedText(each, rows))).toEqual(["Tied with B, gone", null]);
  });

  it("count those they are tied with where they are many", () => {
    const tied_with = ["c", "d", "e", "f", "g", "h", "i"];
    expect(tiedText(row("a", 0.5, { tied_with }), [])).toBe("Tied with c, d, e, f, g and 2 others");
  });

  it("take the best from people's entries before baselines and ceilings", () => {
    const baseline = row("lsd", 0.9);
    baseline.method.kind = "baseline";
    const ceiling = row("people", 0.99);
    ceiling.method.kind = "ceiling";
    expect(bestRow([ceiling, baseline, row("mine", 0.4)])?.method.slug).toBe("mine");
    expect(bestRow([ceiling, baseline])?.method.slug).toBe("lsd");
    expect(bestRow([ceiling])).toBeNull();
  });

  it("show only metrics that some row has", () => {
    expect(knownMetrics([row("a", 0.5)], ["f1", "ap"])).toEqual(["f1"]);
  });
});
