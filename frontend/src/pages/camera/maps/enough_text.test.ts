import { expect, it } from "vitest";
import { enoughText } from "./enough_text";

it("says how many lines are enough, and where none are", () => {
  expect(enoughText({ lines: 12, needed: 1400 })).toBe(
    "It takes about 1,400 lines such as these; there are 12.",
  );
  expect(enoughText({ lines: 662, needed: 14 })).toBe(
    "Fitted to 662 lines, where about 14 lines such as these are enough.",
  );
  expect(enoughText({ lines: 662, needed: 100_000 })).toBe("No number of lines such as these would do.");
});
