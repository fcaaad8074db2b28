import type { Submission } from "../../api/board_types";
import { formatQuantity, sentence } from "../../design/format";
import { Note } from "../note";

/** Why there is no score. */
export function FailureNote({ submission }: { submission: Submission }) {
  const { status, error, attempts } = submission;
  if (status !== "failed" && status !== "invalid") return null;
  return (
    <Note tone="danger">
      <strong>
        {status === "invalid"
          ? "These files can't be scored."
          : `Scoring failed after ${formatQuantity(attempts, "attempt")}.`}
      </strong>{" "}
      {error ? sentence(error.message) : ""}
      {error?.where ? ` Where: ${error.where}.` : ""}
      {error?.expected ? ` Expected: ${error.expected}.` : ""} {error?.hint ? sentence(error.hint) : ""} It
      stands on no board and doesn't count for the daily limit.
    </Note>
  );
}
