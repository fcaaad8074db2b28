import { sentence } from "../design/format";
import type { ErrorInfo, Problem } from "./types";

/** A request that the server answered with a problem document, or that never reached it (status 0). */
export class RequestFailed extends Error {
  readonly problem: Problem;

  constructor(problem: Problem) {
    super(problem.message);
    this.name = "RequestFailed";
    this.problem = problem;
  }

  /** True where sending the same request again later may succeed. */
  get temporary(): boolean {
    const { status } = this.problem;
    return status === 0 || status === 408 || status === 429 || status >= 500;
  }
}

const UNREACHABLE: Problem = {
  title: "Server not reachable",
  status: 0,
  code: "unreachable",
  message: "The ClearLines server doesn't answer.",
  hint: "Is it still running? Nothing you decided is lost; it is sent as soon as the server is back.",
};

export function unreachable(): RequestFailed {
  return new RequestFailed(UNREACHABLE);
}

/** The problem in an answer that isn't ok; proxies answer without a problem document, so one is made. */
export function problemFrom(body: unknown, response: Response): RequestFailed {
  if (isProblem(body)) return new RequestFailed(body);
  return new RequestFailed({
    title: response.statusText || "Request failed",
    status: response.status,
    code: `http-${response.status}`,
    message: `The server answered with status ${response.status}.`,
  });
}

/** Anything that went wrong as a problem, so that every error state can be shown in one form. */
export function asProblem(error: unknown, title = "Something went wrong"): Problem {
  if (error instanceof RequestFailed) return error.problem;
  // First: a DOMException has a code too, and spread it would leave its message behind.
  if (error instanceof Error) return { title, status: 0, code: "unexpected", message: error.message };
  if (isErrorInfo(error)) return { title, status: 0, ...error };
  return { title, status: 0, code: "unexpected", message: String(error) };
}

/** What is wrong, what was expected and what would help, for the place below a form's fields. */
export function problemText(error: unknown): string {
  const { message, expected, hint } = asProblem(error);
  return [message, expected ? `Expected: ${expected}` : null, hint]
    .flatMap((text) => (text ? [sentence(text)] : []))
    .join(" ");
}

function isProblem(body: unknown): body is Problem {
  return isErrorInfo(body) && "title" in body && "status" in body;
}

function isErrorInfo(body: unknown): body is ErrorInfo {
  return typeof body === "object" && body !== null && "code" in body && "message" in body;
}
