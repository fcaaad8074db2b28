import { useQuery } from "@tanstack/react-query";
import type { ReactNode } from "react";
import { Link, useParams } from "react-router";
import { submissionQuery } from "../../api/board_queries";
import type { Submission } from "../../api/board_types";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState, LoadingState } from "../../design/states";
import { submissionName } from "./submission_name";
import { ViewerWorkspace } from "./viewer_workspace";
import "../../image_view/image_view.css";
import "../../image_view/panel.css";
import "./viewer.css";

/** One image as a submission was scored on it; its address can be shared. */
export function ViewerPage() {
  const { id = "", splitImageId = "" } = useParams();
  const submission = useQuery(submissionQuery(Number(id)));
  if (submission.data === undefined) {
    return (
      <PageFrame crumbs={[{ label: "Leaderboards", to: "/splits" }, { label: "Image" }]}>
        {submission.isError ? (
          <ErrorState error={submission.error} onRetry={() => submission.refetch()} />
        ) : (
          <LoadingState label="Loading the submission" />
        )}
      </PageFrame>
    );
  }
  const reason = whyNotShown(submission.data);
  if (reason !== null) return <NotShown submission={submission.data}>{reason}</NotShown>;
  return <ViewerWorkspace submission={submission.data} imageId={Number(splitImageId)} />;
}

/** Why a submission has no images to be looked at; null where it has. */
function whyNotShown({ split, status, can }: Submission): string | null {
  if (!can.see_details && split.visibility === "hidden") {
    return "Its labels are hidden. What was found and missed on an image would give them away, so only the totals are shown.";
  }
  if (status === "invalid" || status === "failed") return "It has no scores. The submission page says why.";
  if (status !== "scored" && status !== "withdrawn") {
    return "The images can be looked at as soon as the submission is scored.";
  }
  return null;
}

function NotShown({ submission, children }: { submission: Submission; children: ReactNode }) {
  const { id, split } = submission;
  const hidden = split.visibility === "hidden";
  return (
    <PageFrame
      crumbs={[
        { label: "Leaderboards", to: "/splits" },
        { label: split.name, to: `/splits/${split.slug}` },
        { label: submissionName(submission), to: `/submissions/${id}` },
        { label: "Image" },
      ]}
    >
      <EmptyState
        icon={hidden ? "eyeOff" : "clock"}
        title={hidden ? "Images of a hidden split aren't shown" : "Not scored"}
        actions={
          <Link className={buttonClass("primary")} to={`/submissions/${id}`}>
            To the submission
          </Link>
        }
      >
        {children}
      </EmptyState>
    </PageFrame>
  );
}
