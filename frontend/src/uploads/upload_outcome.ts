/** What the server's report says of each file that was sent. */

import type { ErrorInfo, Problem, UploadReport } from "../api/types";

interface Outcome {
  state: "existing" | "failed";
  error: ErrorInfo | null;
}

export interface Outcomes {
  /** By path as sent; a file that isn't named here was added. */
  byPath: Map<string, Outcome>;
  /** Files inside a zip that failed. */
  inside: { path: string; error: ErrorInfo }[];
}

export function outcomesOf(paths: readonly string[], report: UploadReport): Outcomes {
  const byPath = new Map<string, Outcome>();
  const inside: Outcomes["inside"] = [];
  const known = new Map(paths.flatMap((path) => [[path, path] as const, [stem(path), path] as const]));
  for (const { name, error } of report.failed) {
    const path = known.get(name) ?? known.get(stem(name));
    if (path) byPath.set(path, { state: "failed", error });
    else inside.push({ path: paths.length === 1 ? `${paths[0]} › ${name}` : name, error });
  }
  for (const { name } of report.existing) {
    const path = known.get(name) ?? known.get(stem(name));
    if (path && !byPath.has(path)) byPath.set(path, { state: "existing", error: null });
  }
  return { byPath, inside };
}

/** The reason of each file, where the server refused a request because of its files. */
export function failuresOf(problem: Problem): Map<string, ErrorInfo> {
  const failed: unknown = problem.details?.failed;
  if (!Array.isArray(failed)) return new Map();
  return new Map((failed as UploadReport["failed"]).map(({ name, error }) => [name, error]));
}

function stem(path: string): string {
  return path.replace(/\.[^./]+$/, "");
}
