import { expect, it } from "vitest";
import { nextImageSort, readImageSort } from "./image_sort";

it("shows the worst image first where the address doesn't say otherwise", () => {
  expect(readImageSort(null)).toBe("f1");
  expect(readImageSort("-secret")).toBe("f1");
  expect(readImageSort("-fp")).toBe("-fp");
});

it("begins a column with its worst end and turns round at the second press", () => {
  expect(nextImageSort("f1", "fp")).toBe("-fp");
  expect(nextImageSort("-fp", "fp")).toBe("fp");
  expect(nextImageSort("fp", "f1")).toBe("f1");
  expect(nextImageSort("f1", "f1")).toBe("-f1");
});
