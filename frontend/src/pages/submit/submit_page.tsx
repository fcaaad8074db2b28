import { useQuery } from "@tanstack/react-query";
import { Link, useParams, useSearchParams } from "react-router";
import { meQuery, splitQuery } from "../../api/board_queries";
import type { Split } from "../../api/board_types";
import { asProblem } from "../../api/problem";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { NoSuchSplit } from "../board/board_page";
import { Note } from "../note";
import { DeadlineBadge, VisibilityBadge } from "../split_badges";
import { OwnSubmissions } from "./own_submissions";
import { SubmissionProgress } from "./submission_progress";
import { SubmitForm } from "./submit_form";
import "../board_page.css";
import "./submit.css";

/** Hands in results for a split, and follows them until they are scored. */
export function SubmitPage() {
  const { split: slug = "" } = useParams();
  const split = useQuery(splitQuery(slug));
  const missing = split.isError && asProblem(split.error).status === 404;
  return (
    <PageFrame
      crumbs={[
        { label: "Leaderboards", to: "/splits" },
        { label: split.data?.name ?? slug, to: `/splits/${slug}` },
        { label: "Submit" },
      ]}
    >
      {split.data && !missing ? (
        <SubmitView key={slug} split={split.data} />
      ) : missing ? (
        <NoSuchSplit />
      ) : split.isError ? (
        <ErrorState error={split.error} onRetry={() => split.refetch()} />
      ) : (
        <div className="board-page" role="status" aria-label="Loading the split">
          <div className="skeleton board-page__loading" />
        </div>
      )}
    </PageFrame>
  );
}

function SubmitView({ split }: { split: Split }) {
  const [parameters, setParameters] = useSearchParams();
  const sent = Number(parameters.get("submission"));
  return (
    <div className="board-page submit-page">
      <header className="board-page__title">
        <h1>Submit to {split.name}</h1>
        <p className="board-page__facts muted numeric">
          <VisibilityBadge visibility={split.visibility} />
          <DeadlineBadge split={split} />
          {split.daily_limit ? <span>{split.daily_limit} scored per day and person</span> : null}
        </p>
      </header>
      {Number.isInteger(sent) && sent > 0 ? (
        <SubmissionProgress key={sent} id={sent} onAnother={() => setParameters({})} />
      ) : split.closed ? (
        <Note tone="warning">
          <strong>This split is closed.</strong> It takes no further submissions; its board stays.
        </Note>
      ) : split.can.submit ? (
        <SubmitForm split={split} onSent={(id) => setParameters({ submission: String(id) })} />
      ) : (
        <MayNot split={split} />
      )}
      <OwnSubmissions split={split} />
    </div>
  );
}

function MayNot({ split }: { split: Split }) {
  const me = useQuery(meQuery);
  return (
    <EmptyState
      icon="lock"
      title={me.data?.anonymous ? "Sign in to submit" : "Your role may not submit"}
      actions={
        <Link to={`/splits/${split.slug}`} className={buttonClass()}>
          Back to the board
        </Link>
      }
    >
      {me.data?.anonymous
        ? "Press Sign in at the top right and enter your token; the role submitter is enough."
        : "Ask whoever runs this server for a token with the role submitter."}
    </EmptyState>
  );
}
