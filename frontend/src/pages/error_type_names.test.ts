import { describe, expect, it } from "vitest";
import { errorTypeOf } from "./error_type_names";

describe("kinds of errors", () => {
  it("are known however they are spelled", () => {
    expect(errorTypeOf("wrong_angle")?.name).toBe("wrong angle");
    expect(errorTypeOf("over-extended")?.name).toBe("over-extended");
  });

  it("may be new", () => {
    expect(errorTypeOf("something_new")).toEqual({ name: "something new", why: "" });
  });

  it("are absent where there is no error", () => {
    expect(errorTypeOf(null)).toBeNull();
  });
});
