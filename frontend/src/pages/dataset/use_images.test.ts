import { expect, it } from "vitest";
import { countOf } from "./use_images";

it("knows how many images there are where the server counted them all", () => {
  expect(countOf({ total: 60_000, total_exact: true, next_cursor: "c" }, 200)).toEqual({
    total: 60_000,
    exact: true,
  });
  expect(countOf(undefined, 0)).toEqual({ total: 0, exact: true });
});

it("always has room for one more where it didn't, and knows at the end", () => {
  const page = { total: 1000, total_exact: false, next_cursor: "c" };
  expect(countOf(page, 200)).toEqual({ total: 1000, exact: false });
  expect(countOf(page, 1200)).toEqual({ total: 1201, exact: false });
  expect(countOf({ ...page, next_cursor: null }, 1250)).toEqual({ total: 1250, exact: true });
});
