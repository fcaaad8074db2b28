import type { Submission } from "../../api/board_types";
import { formatDate, formatQuantity, sentence } from "../../design/format";
import { EmptyState } from "../../design/states";
import { Names } from "../submit/validation_report";

/** What happened to a submission, step by step. */
export function LogTab({ submission }: { submission: Submission }) {
  const { log, missing, attempts } = submission;
  return (
    <section className="section card" aria-labelledby="log-title">
      <header className="section__header">
        <h2 id="log-title">Log</h2>
        {attempts > 1 ? <span className="muted numeric">{formatQuantity(attempts, "attempt")}</span> : null}
      </header>
      {log.length === 0 ? (
        <EmptyState icon="info" title="Nothing has been written down yet" />
      ) : (
        <ol className="log">
          {log.map(({ at, text }) => (
            <li key={`${at} ${text}`}>
              <time className="muted numeric" dateTime={at} title={at}>
                {formatDate(at)}
              </time>
              <span>{sentence(text)}</span>
            </li>
          ))}
        </ol>
      )}
      <Names names={missing} one="image" text="without results: scored as if nothing was found there" />
    </section>
  );
}
