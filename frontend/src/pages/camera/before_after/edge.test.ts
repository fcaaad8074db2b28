import { describe, expect, it } from "vitest";
import { edgeAfterKey, edgeText } from "./edge";

describe("the edge", () => {
  it("moves by keys and stays within the image", () => {
    expect(edgeAfterKey("ArrowRight", 0.5, false)).toBe(0.52);
    expect(edgeAfterKey("ArrowLeft", 0.5, true)).toBe(0.4);
    expect(edgeAfterKey("ArrowLeft", 0.01, false)).toBe(0);
    expect(edgeAfterKey("PageUp", 0.95, false)).toBe(1);
    expect([edgeAfterKey("Home", 0.3, false), edgeAfterKey("End", 0.3, false)]).toEqual([0, 1]);
    expect(edgeAfterKey("Enter", 0.3, false)).toBeNull();
  });

  it("comes back to where it was", () => {
    let share = 0.5;
    for (let step = 0; step < 7; step++) share = edgeAfterKey("ArrowRight", share, false) ?? -1;
    for (let step = 0; step < 7; step++) share = edgeAfterKey("ArrowLeft", share, false) ?? -1;
    expect(share).toBe(0.5);
  });

  it("is told in words", () => {
    expect([0, 0.4, 1].map(edgeText)).toEqual(["After only", "40 % before, 60 % after", "Before only"]);
  });
});
