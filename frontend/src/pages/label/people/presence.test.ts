import { describe, expect, it } from "vitest";
import { presenceText } from "./presence";

describe("presence", () => {
  it("names up to two people", () => {
    expect(presenceText(["Mara"])).toBe("Mara is here");
    expect(presenceText(["Mara", "Jon"])).toBe("Mara and Jon are here");
    expect(presenceText(["Mara", "Jon", "Lee"])).toBe("Mara and 2 others are here");
  });
});
