import type { Submission } from "../../api/board_types";

/** "OpenCV LSD v3": the method and the author's word for this version of it. */
export function submissionName({ method, label }: Pick<Submission, "method" | "label">): string {
  return label ? `${method.name} ${label}` : method.name;
}
