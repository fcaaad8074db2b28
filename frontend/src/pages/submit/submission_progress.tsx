import { Link } from "react-router";
import type { Submission } from "../../api/board_types";
import { isFinal } from "../../api/follow_submission";
import { Button, buttonClass } from "../../design/button";
import { formatQuantity, sentence } from "../../design/format";
import { ErrorState } from "../../design/states";
import { intervalText, metricText } from "../metrics";
import { useSubmission } from "../use_submission";
import { Steps } from "./steps";

/** A submission on its way, from the upload to the result. */
export function SubmissionProgress({ id, onAnother }: { id: number; onAnother: () => void }) {
  const submission = useSubmission(id);
  if (submission.isError) return <ErrorState error={submission.error} onRetry={() => submission.refetch()} />;
  if (!submission.data) {
    return <div className="skeleton submit-progress" role="status" aria-label="Loading the submission" />;
  }
  return (
    <section className="submit-progress card" aria-label="Progress of the submission">
      <header className="section__header">
        <h2>
          {submission.data.method.name}
          {submission.data.label ? <span className="muted"> {submission.data.label}</span> : null}
        </h2>
        <span className="muted numeric">
          {formatQuantity(submission.data.segments, "segment")} in{" "}
          {formatQuantity(submission.data.images, "image")}
        </span>
      </header>
      <Steps submission={submission.data} />
      <Outcome submission={submission.data} />
      <div className="submit-progress__actions">
        <Link
          to={`/submissions/${id}`}
          className={buttonClass(submission.data.status === "scored" ? "primary" : "default")}
        >
          Open the submission
        </Link>
        <Button icon="plus" onClick={onAnother}>
          Submit another
        </Button>
      </div>
    </section>
  );
}

function Outcome({ submission }: { submission: Submission }) {
  const { status, error } = submission;
  const f1 = submission.scores.find(({ protocol }) => protocol === "clearlines-v2")?.totals.f1;
  return (
    <p role="status" className="submit-progress__outcome">
      {status === "scored" && f1 ? (
        <>
          F1 <strong className="submit-progress__f1 numeric">{metricText("f1", f1.value)}</strong>{" "}
          <span className="muted numeric">{intervalText("f1", f1)}</span>
        </>
      ) : null}
      {error && isFinal(submission) ? (
        <span className="field__error">
          {sentence(error.message)} {error.hint ? sentence(error.hint) : ""} It doesn't count for the daily
          limit.
        </span>
      ) : null}
    </p>
  );
}
