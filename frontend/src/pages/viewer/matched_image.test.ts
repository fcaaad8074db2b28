import { describe, expect, it } from "vitest";
import { lineNamed, makeMatchedImage } from "./matched_image";
import { detailOf, matched, polylinesOf } from "./test_images";

const image = matched(
  [
    { row: [0, 100, 10], outcome: "hit" },
    { row: [0, 100, 50], outcome: "miss", error_type: "fragmented" },
    { row: [0, 100, 90], outcome: "ignored", ignored: true },
  ],
  [
    { row: [0, 95, 10], outcome: "hit", best_label: 0, liou: 0.9, offset: 0.5, angle: 0.01 },
    { row: [0, 100, 11], outcome: "false_alarm", best_label: 0, liou: 0.95, error_type: "duplicate" },
    { row: [0, 30, 50], outcome: "false_alarm", best_label: 1, liou: 0.3, error_type: "fragment" },
    { row: [200, 300, 300], outcome: "false_alarm", best_label: 0, liou: 0, error_type: "background" },
    { row: [0, 100, 90], outcome: "ignored", best_label: 2, liou: 1 },
  ],
);
const line = (name: string) => lineNamed(image, name);

describe("a scored image", () => {
  it("sorts its lines into layers", () => {
    expect(image.lines.map(({ name, layer }) => `${name} ${layer}`)).toEqual([
      "l0 found",
      "l1 fn",
      "l2 ignored",
      "p0 tp",
      "p1 fp",
      "p2 fp",
      "p3 fp",
      "p4 ignored",
    ]);
    expect(image.counts).toEqual({ tp: 1, fp: 3, fn: 1, ignored: 2, found: 1 });
  });

  it("leads from a prediction to its closest label, and nowhere where none is near", () => {
    expect(line("p2")?.partner).toBe(line("l1")?.index);
    expect(line("p3")).toMatchObject({ partner: null, liou: null });
  });

  it("leads from a label to the prediction that counts for it, even if a duplicate covers it better", () => {
    expect(line("l0")).toMatchObject({ partner: line("p0")?.index, liou: 0.9, offset: 0.5, angle: 0.01 });
    expect(line("l1")).toMatchObject({ partner: line("p2")?.index, liou: 0.3, errorType: "fragmented" });
  });

  it("keeps the scene's order, whatever the order of the points", () => {
    const turned = {
      ...polylinesOf([
        [0, 9, 5],
        [0, 9, 7],
      ]),
      ids: Uint32Array.of(1, 0),
    };
    const found = makeMatchedImage(detailOf([{ row: [0, 9, 7] }], [{ row: [0, 9, 5] }]), turned);
    expect(found.lines.map(({ name, index }) => [name, index])).toEqual([
      ["p0", 0],
      ["l0", 1],
    ]);
  });

  it("refuses the points of another image", () => {
    const polylines = polylinesOf([[0, 9, 5]]);
    expect(() => makeMatchedImage(detailOf([{ row: [0, 9, 5] }], [{ row: [0, 9, 5] }]), polylines)).toThrow(
      "1 lines instead of 2",
    );
    const others = { ...polylines, ids: Uint32Array.of(4) };
    expect(() => makeMatchedImage(detailOf([{ row: [0, 9, 5] }], []), others)).toThrow(
      "Line 0 has no points",
    );
  });
});
