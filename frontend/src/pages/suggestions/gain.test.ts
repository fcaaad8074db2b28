import { describe, expect, it } from "vitest";
import { gainText, latestSaving } from "./gain";

const entry = (images: number, keys: number, by_hand: number) => ({
  images,
  keys,
  keys_by_hand: by_hand,
  candidates: by_hand,
});

describe("what the latest images spared", () => {
  it("counts those alone that a model of the dataset suggested for", () => {
    const saving = latestSaving([entry(0, 90, 100), entry(1, 30, 100), entry(2, 20, 100)]);
    expect(saving).toEqual({ images: 2, keys: 50, byHand: 200, share: 0.75 });
  });

  it("looks at the end of the list", () => {
    const gain = [entry(1, 100, 100), entry(2, 10, 100), entry(2, 30, 100)];
    expect(latestSaving(gain, 2)?.share).toBeCloseTo(0.8);
  });

  it("is below nothing where suggestions cost more than they spare", () => {
    expect(latestSaving([entry(1, 120, 100)])?.share).toBeCloseTo(-0.2);
  });

  it("is unknown before anything was learnt", () => {
    expect(latestSaving([entry(0, 90, 100)])).toBeNull();
    expect(latestSaving([])).toBeNull();
  });
});

it("says what one image would have cost", () => {
  expect(gainText(entry(0, 40, 109))).toBe("40 keys instead of 109, by the general model");
  expect(gainText(entry(3, 12, 109))).toBe("12 keys instead of 109, learnt from 3 before");
});
