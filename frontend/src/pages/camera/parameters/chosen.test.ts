import { expect, it } from "vitest";
import { isChosen } from "./chosen";

it("knows the model that was chosen among those that were better than the one before", () => {
  const chosen = { lens: { family: "opencv" as const }, released: ["k1", "k2"] };
  expect(isChosen({ family: "opencv", released: ["k1", "k2"], accepted: true }, chosen)).toBe(true);
  expect(isChosen({ family: "opencv", released: ["k1"], accepted: true }, chosen)).toBe(false);
  expect(isChosen({ family: "brown", released: ["k1", "k2"], accepted: true }, chosen)).toBe(false);
  expect(isChosen({ family: "opencv", released: ["k1", "k2"], accepted: false }, chosen)).toBe(false);
});
