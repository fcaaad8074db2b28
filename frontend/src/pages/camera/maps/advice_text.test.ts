import { expect, it } from "vitest";
import { adviceText } from "./advice_text";

const CELL = { x: 40.2, y: 300, column: 0, row: 9, sigma_now: 2.4, sigma_with: 1.1, halves: true };

it("says what five more lines would do", () => {
  expect(adviceText(CELL)).toBe(
    "Five more lines around (40, 300) would halve the uncertainty there: 1.10 px instead of 2.40 px.",
  );
  expect(adviceText({ ...CELL, sigma_with: 1.8, halves: false })).toContain(
    "would take 25 % of the uncertainty",
  );
});
