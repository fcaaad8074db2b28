import { Link, useParams, useSearchParams } from "react-router";
import type { Submission } from "../../api/board_types";
import { isFinal } from "../../api/follow_submission";
import { formatCount } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { ALL_LEADERBOARDS, Fetched, Missing, PageSkeleton } from "../fetched";
import { Note } from "../note";
import { Steps } from "../submit/steps";
import { useSubmission } from "../use_submission";
import { CompareTab } from "./compare_tab";
import { FailureNote } from "./failure_note";
import { ImagesTab } from "./images_tab";
import { LogTab } from "./log_tab";
import { Overview } from "./overview";
import { SubmissionHeader } from "./submission_header";
import "../board_page.css";
import "./submission.css";
import "./totals.css";

const TABS = ["overview", "images", "compare", "log"] as const;
type Tab = (typeof TABS)[number];

/** One submission: its numbers, where they come from, its images and its log. */
export function SubmissionPage() {
  const { id = "" } = useParams();
  const submission = useSubmission(Number(id));
  const { data } = submission;
  return (
    <PageFrame
      crumbs={[
        { label: "Leaderboards", to: "/splits" },
        ...(data ? [{ label: data.split.name, to: `/splits/${data.split.slug}` }] : []),
        { label: data ? `${data.method.name}${data.label ? ` ${data.label}` : ""}` : `Submission ${id}` },
      ]}
    >
      <Fetched
        query={submission}
        missing={
          <Missing what="submission" list={ALL_LEADERBOARDS}>
            The address may be mistyped, or the submission is private and somebody else's.
          </Missing>
        }
        loading={<PageSkeleton what="the submission" />}
      >
        {(known) => <SubmissionView key={id} submission={known} />}
      </Fetched>
    </PageFrame>
  );
}

function SubmissionView({ submission }: { submission: Submission }) {
  const [parameters] = useSearchParams();
  const { status, can, split } = submission;
  const details = can.see_details && status === "scored";
  const numbers = status !== "failed" && status !== "invalid";
  const tabs = TABS.filter((name) => details || name === "log" || (name === "overview" && numbers));
  const tab = tabs.find((name) => name === parameters.get("tab")) ?? tabs[0];
  return (
    <div className="board-page">
      <SubmissionHeader submission={submission} />
      {isFinal(submission) ? null : (
        <section className="section card" aria-label="Progress">
          <Steps submission={submission} />
        </section>
      )}
      <FailureNote submission={submission} />
      {status === "withdrawn" ? <Note>This submission was withdrawn: it stands on no board.</Note> : null}
      {status === "scored" && !can.see_details && split.visibility === "hidden" ? (
        <Note icon="lock">
          The labels of this split are hidden, so rounded totals are all there is to see: results per image
          would give the labels away.
        </Note>
      ) : null}
      <Tabs tabs={tabs} tab={tab} images={submission.images} />
      {tab === "overview" ? <Overview submission={submission} /> : null}
      {tab === "images" ? <ImagesTab submission={submission} /> : null}
      {tab === "compare" ? <CompareTab submission={submission} /> : null}
      {tab === "log" ? <LogTab submission={submission} /> : null}
    </div>
  );
}

const NAMES: Record<Tab, string> = { overview: "Overview", images: "Images", compare: "Compare", log: "Log" };

function Tabs({ tabs, tab, images }: { tabs: readonly Tab[]; tab: Tab | undefined; images: number }) {
  return (
    <nav className="tabs" aria-label="Parts of the submission">
      {tabs.map((name) => (
        <Link
          key={name}
          className="tabs__tab"
          to={name === tabs[0] ? "?" : `?tab=${name}`}
          aria-current={name === tab ? "page" : undefined}
        >
          {NAMES[name]}
          {name === "images" ? <span className="tabs__count">{formatCount(images)}</span> : null}
        </Link>
      ))}
    </nav>
  );
}
