import { expect, test } from "vitest";
import { namesOf } from "./names";

test("names, each once", () => {
  expect(namesOf(" Mara, Jon ;  Ada   L.\nMara,, ")).toEqual(["Mara", "Jon", "Ada L."]);
  expect(namesOf("  ,")).toEqual([]);
});
