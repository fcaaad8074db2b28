import { Link } from "react-router";
import { submissionFileUrl, submissionMatchesUrl } from "../api/board_endpoints";
import type { Submission, Totals } from "../api/board_types";
import { Badge } from "../design/badge";
import { formatDate, formatQuantity } from "../design/format";
import { Icon } from "../design/icons";
import { Popover } from "../design/popover";
import { intervalText, metricText } from "./metrics";
import { SubmissionBadge } from "./split_badges";
import { useSubmissionActions } from "./use_submission_actions";
import "./submission_table.css";

interface SubmissionTableProps {
  submissions: readonly Submission[];
  withMethod?: boolean;
  withSplit?: boolean;
}

/** Submissions with their state, their F1 and what can be done with them. */
export function SubmissionTable({ submissions, withMethod, withSplit }: SubmissionTableProps) {
  return (
    <div className="submission-table">
      <table className="table">
        <thead>
          <tr>
            <th scope="col">{withMethod ? "Method" : "Version"}</th>
            {withSplit ? <th scope="col">Split</th> : null}
            <th scope="col">State</th>
            <th scope="col">F1</th>
            <th scope="col" className="table__number">
              Sent
            </th>
            <th>
              <span className="visually-hidden">Actions</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {submissions.map((submission) => (
            <Row key={submission.id} submission={submission} withMethod={withMethod} withSplit={withSplit} />
          ))}
        </tbody>
      </table>
    </div>
  );
}

interface RowProps {
  submission: Submission;
  withMethod: boolean | undefined;
  withSplit: boolean | undefined;
}

function Row({ submission, withMethod, withSplit }: RowProps) {
  const { id, method, label, split, status, position, progress, visibility, created_at, error } = submission;
  const f1 = rankTotals(submission)?.f1;
  const name = withMethod ? method.name : (label ?? `Submission ${id}`);
  const part =
    status === "queued" && position !== null
      ? `place ${position}`
      : status === "scoring"
        ? `${Math.floor(progress * 100)} %`
        : "";
  return (
    <tr>
      <th scope="row" className="submission-table__name">
        <Link to={`/submissions/${id}`} title={name}>
          {name}
        </Link>
        {withMethod && label ? <span className="table__small">{label}</span> : null}
      </th>
      {withSplit ? (
        <td>
          <Link to={`/splits/${split.slug}`}>{split.name}</Link>
        </td>
      ) : null}
      <td>
        <span className="submission-table__state">
          <SubmissionBadge status={status} />
          {part ? <span className="muted numeric">{part}</span> : null}
          {visibility === "private" ? <Badge icon="lock">Private</Badge> : null}
        </span>
        {error && (status === "failed" || status === "invalid") ? (
          <span className="table__small submission-table__error">{error.message}</span>
        ) : null}
      </td>
      <td className="submission-table__f1">
        {f1 ? (
          <>
            <strong>{metricText("f1", f1.value)}</strong>{" "}
            <span className="table__small">{intervalText("f1", f1)}</span>
          </>
        ) : (
          "–"
        )}
      </td>
      <td className="table__number table__small">
        <time dateTime={created_at}>{formatDate(created_at)}</time>
      </td>
      <td className="table__number">
        <Actions submission={submission} />
      </td>
    </tr>
  );
}

/** What can be done with a submission, as a menu. */
function Actions({ submission }: { submission: Submission }) {
  const { withdraw, restore, setVisibility } = useSubmissionActions();
  const { id, can, mine, status, visibility, method } = submission;
  const changeable = mine || can.withdraw;
  if (!changeable && !can.download) return null;
  return (
    <Popover label={`More for ${method.name}, submission ${id}`} icon="more" iconOnly tone="quiet" small>
      {(close) => {
        const act = (run: () => void) => () => {
          close();
          run();
        };
        return (
          <>
            {can.download ? <Downloads submission={submission} /> : null}
            {changeable && status !== "withdrawn" ? (
              <button
                type="button"
                className="menu-item"
                onClick={act(() => void setVisibility(id, visibility === "public" ? "private" : "public"))}
              >
                <Icon name={visibility === "public" ? "lock" : "eye"} />
                {visibility === "public" ? "Make private" : "Make public"}
              </button>
            ) : null}
            {status === "withdrawn" && mine ? (
              <button type="button" className="menu-item" onClick={act(() => void restore(id))}>
                <Icon name="undo" /> Put back
              </button>
            ) : null}
            {can.withdraw ? (
              <button
                type="button"
                className="menu-item menu-item--danger"
                onClick={act(() => void withdraw(submission))}
              >
                <Icon name="trash" /> Withdraw
              </button>
            ) : null}
          </>
        );
      }}
    </Popover>
  );
}

export function Downloads({ submission }: { submission: Submission }) {
  const { id, can, mine, status } = submission;
  return (
    <>
      {mine ? (
        <a className="menu-item submission-table__link" href={submissionFileUrl(id, "upload")} download="">
          <Icon name="download" /> What was sent
        </a>
      ) : null}
      <a className="menu-item submission-table__link" href={submissionFileUrl(id, "npz")} download="">
        <Icon name="download" /> Segments as npz
      </a>
      {can.see_details && status === "scored" ? (
        <a
          className="menu-item submission-table__link"
          href={submissionMatchesUrl(id)}
          download={`matches-${id}.json`}
        >
          <Icon name="download" /> Matches as JSON
        </a>
      ) : null}
    </>
  );
}

/** The totals that the rank goes by; null before it is scored. */
export function rankTotals({ scores }: Pick<Submission, "scores">): Totals | null {
  const ranked = scores.filter(({ protocol }) => protocol.startsWith("clearlines-v2"));
  return ranked.at(-1)?.totals ?? null;
}

/** "12,331 segments in 85 images". */
export function sizeText({ segments, images }: Pick<Submission, "segments" | "images">): string {
  return `${formatQuantity(segments, "segment")} in ${formatQuantity(images, "image")}`;
}
