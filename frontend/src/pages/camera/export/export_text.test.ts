import { describe, expect, it } from "vitest";
import { curlText, errorText, intrinsicsText, readGiven, wholeErrorText } from "./export_text";

describe("the error of an export", () => {
  it("is exact, in px, or too much", () => {
    expect(errorText({ allowed: true, error: { rms: 1e-6, maximum: 1e-5 } })).toBe("exact");
    expect(errorText({ allowed: true, error: { rms: 0.0123, maximum: 0.05 } })).toBe("0.012 px");
    expect(errorText({ allowed: false, error: { rms: 3, maximum: 9 } })).toBe("refused");
    expect(wholeErrorText({ error: { rms: 3, maximum: 9 } })).toBe("3.00 px RMS, 9.00 px at most");
  });
});

it("says clearly where a focal length comes from", () => {
  const intrinsics = { focal_length: 1242, principal_point: [620.5, 187] as [number, number] };
  expect(intrinsicsText({ ...intrinsics, source: "nominal" })).toBe(
    "Focal length 1242 px, nominal: made up, since these images don't tell it; principal point (621, 187)",
  );
});

it("makes a line for a shell, whatever the names hold", () => {
  expect(curlText("http://localhost:1", "/api/calibrations/3/exports/ros?cx=1&cy=2", "it's.yaml")).toBe(
    "curl -fsS 'http://localhost:1/api/calibrations/3/exports/ros?cx=1&cy=2' -o 'it'\\''s.yaml'",
  );
});

describe("readGiven", () => {
  it("takes a focal length alone, or with a whole principal point", () => {
    expect(readGiven({ focal: " 721.5 ", cx: "", cy: "" })).toEqual({
      focal_length: 721.5,
      cx: null,
      cy: null,
    });
    expect(readGiven({ focal: "721,5", cx: "609", cy: "172" })).toEqual({
      focal_length: 721.5,
      cx: 609,
      cy: 172,
    });
  });

  it("takes nothing else", () => {
    for (const [focal, cx, cy] of [
      ["", "", ""],
      ["-3", "", ""],
      ["0", "", ""],
      ["wide", "", ""],
      ["700", "3", ""],
      ["700", "x", "3"],
    ] as const) {
      expect(readGiven({ focal, cx, cy })).toBeNull();
    }
  });
});
