import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { asProblem } from "../../api/problem";
import { datasetQuery } from "../../api/queries";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { ErrorState, LoadingState } from "../../design/states";
import { shortName } from "../../image_view/short_name";
import { SaveIndicator } from "../label/saving/save_indicator";
import { secondOutbox } from "./second_outbox";
import { SecondWorkspace } from "./second_workspace";
import { useSecondSession } from "./use_second_session";
import "../../image_view/image_view.css";
import "../../image_view/panel.css";

/** A second review of an image: the same candidates, and nothing of what the first person decided. */
export function SecondPage() {
  const { slug = "", imageId = "" } = useParams();
  const id = Number(imageId);
  const dataset = useQuery(datasetQuery(slug));
  const session = useSecondSession(id);
  const team = `/datasets/${slug}?tab=team`;
  const { review, size, error } = session;
  return (
    <PageFrame
      scrolling={false}
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.data?.name ?? slug, to: team },
        {
          label: review === undefined ? "Second review" : `Second review of ${shortName(review.name)}`,
        },
      ]}
      actions={<SaveIndicator outbox={secondOutbox} />}
    >
      {error ? (
        <ErrorState
          error={error}
          {...(asProblem(error).status === 409 ? {} : { onRetry: session.retry })}
          actions={
            <Link className={buttonClass()} to={team}>
              To the team
            </Link>
          }
        />
      ) : review === undefined || size === undefined ? (
        <LoadingState label="Loading the second review" />
      ) : (
        <SecondWorkspace
          key={review.id}
          slug={slug}
          image={{ id, name: review.name, ...size }}
          review={review}
          session={session}
        />
      )}
    </PageFrame>
  );
}
