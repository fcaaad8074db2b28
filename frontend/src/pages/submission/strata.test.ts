import { describe, expect, it } from "vitest";
import { readErrorTypes, readReasons, readStrata } from "./strata";

const stratum = (name: string, tp: number) => ({
  name,
  tp,
  fp: 0,
  fn: 0,
  f1: { value: 1, low: 0.9, high: 1 },
  precision: { value: 1, low: null, high: null },
  recall: 1,
});

describe("strata", () => {
  it("are read with their intervals, whether given or not", () => {
    const [length] = readStrata({ length: [stratum("100-200 px", 3), stratum("400 px and more", 1)] });
    expect(length?.title).toBe("By length");
    expect(length?.strata[0]).toMatchObject({
      name: "100-200 px",
      f1: { value: 1, low: 0.9, high: 1 },
      recall: { value: 1, low: null, high: null },
    });
  });

  it("without lines are left out, and kinds with a single one too", () => {
    expect(readStrata({ source: [stratum("KITTI", 5)], length: [stratum("a", 5), stratum("b", 0)] })).toEqual(
      [],
    );
  });

  it("may be absent or something else", () => {
    for (const given of [null, undefined, [], "x", { length: null }, { length: [{}, 3] }]) {
      expect(readStrata(given)).toEqual([]);
    }
  });
});

describe("reasons of rejections", () => {
  const reason = [
    { name: "shadow", tp: 0, fp: 1, fn: 0, candidates: 1, share: { value: 1, low: null, high: null } },
    { name: "car", tp: 0, fp: 3, fn: 0, candidates: 40, share: { value: 0.075, low: 0.03, high: 0.15 } },
  ];

  it("tell which false positives people had rejected, beside the strata and not among them", () => {
    const given = { reason, length: [stratum("a", 5), stratum("b", 2)] };
    expect(readStrata(given).map(({ kind }) => kind)).toEqual(["length"]);
    expect(readReasons(given)).toMatchObject({
      total: 4,
      errors: [
        { name: "Car", count: 3, meaning: "of 40 such lines: 8 % (3 to 15 %)" },
        { name: "Shadow", count: 1, meaning: "of 1 such line: 100 %" },
      ],
    });
  });

  it("may be absent or something else", () => {
    for (const given of [null, {}, { reason: [] }, { reason: [3, { name: "rain" }] }, { reason: "car" }]) {
      expect(readReasons(given)).toBeNull();
    }
  });
});

describe("error types", () => {
  it("are counted per side, most frequent first", () => {
    const [positives, negatives] = readErrorTypes({ duplicate: 4, background: 1, missed: 2, none: 99 });
    expect(positives?.total).toBe(5);
    expect(positives?.errors[0]?.type).toBe("duplicate");
    expect(negatives?.total).toBe(2);
    expect(negatives?.errors.map(({ count }) => count)).toEqual([2, 0]);
  });

  it("may be absent", () => {
    expect(readErrorTypes(null)).toEqual([]);
  });
});
