import { expect, it } from "vitest";
import { UnsavedLines } from "./unsaved_lines";

it("gives a line back to its image, once, and a single point to none", () => {
  const lines = new UnsavedLines();
  const line = [
    { x: 1, y: 2 },
    { x: 30, y: 4 },
  ];
  lines.leave(7, line);
  lines.leave(8, line.slice(0, 1));
  expect(lines.take(8)).toEqual([]);
  expect(lines.take(7)).toEqual(line);
  expect(lines.take(7)).toEqual([]);
});
