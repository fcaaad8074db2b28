import { expect, it } from "vitest";
import { freeNames } from "./free_names";

it("numbers the names after the first", () => {
  expect(freeNames(" KITTI ", 3)).toEqual(["KITTI", "KITTI 2", "KITTI 3"]);
});

it("has a name for what has none, and room for the number", () => {
  expect(freeNames("", 1)).toEqual(["Uploaded images"]);
  expect(freeNames("x".repeat(300), 2)[1]).toHaveLength(192);
});
