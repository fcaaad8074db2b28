import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { datasetQuery } from "../../api/queries";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState, LoadingState } from "../../design/states";
import { DifferencesWorkspace } from "./differences_workspace";
import { useDifferences } from "./use_differences";
import "../../image_view/image_view.css";
import "../../image_view/panel.css";
import "./differences.css";

/** Where first and second review differ, somebody decides. */
export function DifferencesPage() {
  const { slug = "" } = useParams();
  const dataset = useQuery(datasetQuery(slug));
  const differences = useDifferences(slug);
  const none = differences.loaded && differences.state.differences.length === 0;
  const team = `/datasets/${slug}?tab=team`;
  return (
    <PageFrame
      scrolling={false}
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.data?.name ?? slug, to: team },
        { label: "Differences" },
      ]}
    >
      {differences.error ? (
        <ErrorState error={differences.error} onRetry={differences.retry} />
      ) : none ? (
        <EmptyState
          icon="check"
          title="No differences"
          actions={
            <Link className={buttonClass("primary")} to={team}>
              To the team
            </Link>
          }
        >
          Where an image was reviewed twice, first and second verdicts agree; or no second review is done yet.
        </EmptyState>
      ) : differences.current === null ? (
        <LoadingState label="Loading the differences" />
      ) : (
        <DifferencesWorkspace slug={slug} differences={differences} current={differences.current} />
      )}
    </PageFrame>
  );
}
