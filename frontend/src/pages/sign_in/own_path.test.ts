import { expect, test } from "vitest";
import { ownPath } from "./own_path";

test("a page of this site is gone back to", () => {
  expect(ownPath("/datasets/vienna?tab=runs#2")).toBe("/datasets/vienna?tab=runs#2");
});

test.each([
  [null],
  [""],
  ["https://elsewhere.org/"],
  ["//elsewhere.org/a"],
  ["/\\elsewhere.org"],
  ["/\t/elsewhere.org"],
  ["/..//elsewhere.org"],
  ["//"],
  ["//["],
  ["javascript:alert(1)"],
  ["/sign-in?next=/sign-in"],
])("%j leads to the first page", (next) => {
  expect(ownPath(next)).toBe("/");
});
