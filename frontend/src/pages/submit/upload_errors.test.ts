import { describe, expect, it } from "vitest";
import type { Problem } from "../../api/types";
import { adviceText, errorsText, groupByFile, placeText, readErrors } from "./upload_errors";

const problem = (details: NonNullable<Problem["details"]>): Problem => ({
  title: "Invalid submission",
  status: 422,
  code: "invalid-submission",
  message: "2 files can't be scored",
  hint: "Mend them all at once",
  details,
});

const LISTED = [
  { file: "a.npz", segment: 3, point: 12, message: "x is NaN", expected: "finite numbers", hint: null },
  { file: "b.npz", segment: null, point: null, message: "not an image of this split" },
  { file: "a.npz", segment: 4, point: null, message: "has 1 point", expected: "2 or more", hint: "" },
];

describe("errors of an upload", () => {
  it("are all read, and grouped by file in their order", () => {
    const groups = groupByFile(readErrors(problem({ errors: LISTED })));
    expect(groups.map(({ file, errors }) => [file, errors.length])).toEqual([
      ["a.npz", 2],
      ["b.npz", 1],
    ]);
  });

  it("are none where something else is in the way, or nothing is readable", () => {
    for (const details of [{}, { errors: [] }, { errors: ["?", null, { file: "a" }] }]) {
      expect(readErrors(problem(details))).toEqual([]);
    }
  });

  it("may lie in a field of the form", () => {
    const [error] = readErrors(problem({ errors: [{ where: "body.method", message: "is too long" }] }));
    expect(error).toMatchObject({ file: "body.method", message: "is too long" });
  });

  it("say where, what was expected and what may help", () => {
    expect(placeText({ segment: 3, point: 12 })).toBe("Segment 3, point 12");
    expect(placeText({ segment: 0, point: null })).toBe("Segment 0");
    expect(placeText({ segment: null, point: null })).toBe("");
    const [first] = readErrors(problem({ errors: LISTED }));
    expect(first && adviceText(first)).toBe("Expected: finite numbers.");
  });

  it("can be copied as one text", () => {
    expect(errorsText(readErrors(problem({ errors: LISTED })))).toBe(
      [
        "a.npz",
        "  Segment 3, point 12; x is NaN; expected finite numbers",
        "  Segment 4; has 1 point; expected 2 or more",
        "b.npz",
        "  not an image of this split",
      ].join("\n"),
    );
  });
});
