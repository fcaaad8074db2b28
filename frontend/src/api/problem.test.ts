import { describe, expect, it } from "vitest";
import { asProblem, problemFrom, problemText, RequestFailed, unreachable } from "./problem";

const problem = { title: "Taken", status: 409, code: "name-taken", message: "The name is taken." };

describe("problems", () => {
  it("are what the server says", () => {
    expect(problemFrom(problem, new Response(null, { status: 409 })).problem).toEqual(problem);
  });

  it("are made where a proxy answers", () => {
    const failed = problemFrom("<html>", new Response("", { status: 502 }));
    expect(failed.problem.code).toBe("http-502");
    expect(failed.temporary).toBe(true);
  });

  it("are told in sentences", () => {
    const short = new RequestFailed({
      ...problem,
      message: "too short",
      expected: "10 characters",
      hint: "add words",
    });
    expect(problemText(short)).toBe("Too short. Expected: 10 characters. Add words.");
    expect(problemText(new RequestFailed(problem))).toBe("The name is taken.");
  });

  it("say whether trying again may help", () => {
    expect(unreachable().temporary).toBe(true);
    expect(new RequestFailed(problem).temporary).toBe(false);
  });

  it("are made of an image's error, and of a defect", () => {
    expect(asProblem({ code: "broken-image", message: "Cut off." }, "Failed").title).toBe("Failed");
    expect(asProblem(new TypeError("x is undefined")).message).toBe("x is undefined");
    expect(asProblem(new DOMException("Not decoded.", "EncodingError")).message).toBe("Not decoded.");
  });
});
