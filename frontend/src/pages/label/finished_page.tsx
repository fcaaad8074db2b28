import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { exportUrl } from "../../api/endpoints";
import { datasetQuery } from "../../api/queries";
import type { Dataset } from "../../api/types";
import { buttonClass } from "../../design/button";
import { formatCount, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState, LoadingState } from "../../design/states";
import "./finished.css";

/** What a dataset comes to once its images are done. */
export function FinishedPage() {
  const { slug = "" } = useParams();
  const dataset = useQuery({ ...datasetQuery(slug), refetchOnMount: "always" });
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.data?.name ?? slug, to: `/datasets/${slug}` },
        { label: "Finished" },
      ]}
    >
      {dataset.data ? (
        <Summary dataset={dataset.data} />
      ) : dataset.isError ? (
        <ErrorState error={dataset.error} onRetry={() => dataset.refetch()} />
      ) : (
        <LoadingState label="Counting" />
      )}
    </PageFrame>
  );
}

function Summary({ dataset }: { dataset: Dataset }) {
  const { slug, reviewed, verdicts } = dataset;
  const allDone = reviewed.open === 0;
  const facts: [string, number][] = [
    ["Images done", reviewed.done],
    ["Lines kept", verdicts.keep],
    ["Ambiguous", verdicts.ambiguous],
    ["Rejected", verdicts.reject],
  ];
  return (
    <div className="finished">
      <EmptyState
        icon="check"
        title={allDone ? "All images are done" : `${formatQuantity(reviewed.open, "image")} still open`}
        actions={
          <>
            {allDone ? (
              <a className={buttonClass("primary")} href={exportUrl(slug)} download>
                <Icon name="download" /> Export labels
              </a>
            ) : null}
            <Link className={buttonClass()} to={`/datasets/${slug}`}>
              To the dataset
            </Link>
          </>
        }
      >
        {allDone
          ? `${dataset.name} is ready to be exported in the ClearLines dataset layout.`
          : "Export refuses images that aren't done."}
        {reviewed.discarded > 0 ? ` ${formatQuantity(reviewed.discarded, "image")} discarded.` : null}
      </EmptyState>
      <dl className="finished__facts card">
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd className="numeric">{formatCount(value)}</dd>
          </div>
        ))}
      </dl>
    </div>
  );
}
