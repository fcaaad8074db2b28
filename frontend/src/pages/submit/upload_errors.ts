/** What the server found wrong with an upload, by file. */

import type { UploadError } from "../../api/board_types";
import type { Problem } from "../../api/types";
import { sentence } from "../../design/format";

export interface FileErrors {
  /** Null for what concerns the upload as a whole. */
  file: string | null;
  errors: UploadError[];
}

/** All errors in the files that a problem document lists; none where something else is in the way. */
export function readErrors(problem: Problem): UploadError[] {
  const listed: unknown = problem.details?.errors;
  return Array.isArray(listed) ? listed.flatMap((entry) => readError(entry) ?? []) : [];
}

/** In the order in which the files come first. */
export function groupByFile(errors: readonly UploadError[]): FileErrors[] {
  const groups = new Map<string | null, UploadError[]>();
  for (const error of errors) {
    const group = groups.get(error.file);
    if (group) group.push(error);
    else groups.set(error.file, [error]);
  }
  return [...groups].map(([file, list]) => ({ file, errors: list }));
}

/** "Segment 3, point 12", as the file counts them; empty for a whole file. */
export function placeText({ segment, point }: Pick<UploadError, "segment" | "point">): string {
  if (segment === null) return "";
  return point === null ? `Segment ${segment}` : `Segment ${segment}, point ${point}`;
}

/** All errors as text, to be sent to whoever can mend them. */
export function errorsText(errors: readonly UploadError[]): string {
  return groupByFile(errors)
    .map(({ file, errors: list }) => {
      const lines = list.map((error) => {
        const parts = [
          placeText(error),
          error.message,
          error.expected ? `expected ${error.expected}` : "",
          error.hint ?? "",
        ];
        return `  ${parts.filter((part) => part !== "").join("; ")}`;
      });
      return [file ?? "Upload", ...lines].join("\n");
    })
    .join("\n");
}

/** What was expected and what may help, as sentences. */
export function adviceText({ expected, hint }: UploadError): string {
  return [expected ? sentence(`expected: ${expected}`) : "", hint ? sentence(hint) : ""]
    .filter((part) => part !== "")
    .join(" ");
}

function readError(entry: unknown): UploadError | null {
  if (typeof entry !== "object" || entry === null) return null;
  const { file, where, segment, point, message, expected, hint } = entry as Record<string, unknown>;
  if (typeof message !== "string") return null;
  const text = (value: unknown) => (typeof value === "string" && value !== "" ? value : null);
  const index = (value: unknown) => (typeof value === "number" ? value : null);
  return {
    // Fields of the form have a place of their own, which is no file.
    file: text(file) ?? text(where),
    segment: index(segment),
    point: index(point),
    message,
    expected: text(expected),
    hint: text(hint),
  };
}
