import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { asProblem } from "../../api/problem";
import { datasetQuery } from "../../api/queries";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { UploadPanel } from "../../uploads/upload_panel";
import { useRefreshAfterUploads } from "../../uploads/use_uploads";
import { DatasetView } from "./dataset_view";
import "./dataset.css";

/** One dataset: its images, runs and cameras. */
export function DatasetPage() {
  const { slug = "" } = useParams();
  const dataset = useQuery({ ...datasetQuery(slug), refetchOnMount: "always" });
  useRefreshAfterUploads();
  const missing = dataset.isError && asProblem(dataset.error).status === 404;
  return (
    <PageFrame crumbs={[{ label: "Datasets", to: "/" }, { label: dataset.data?.name ?? slug }]}>
      {dataset.data && !missing ? (
        <DatasetView key={slug} dataset={dataset.data} />
      ) : missing ? (
        <EmptyState
          icon="search"
          title="There is no such dataset"
          actions={
            <Link to="/" className={buttonClass("primary")}>
              All datasets
            </Link>
          }
        >
          It may have been deleted; what was deleted lately can be restored on the page of all datasets.
        </EmptyState>
      ) : dataset.isError ? (
        <ErrorState error={dataset.error} onRetry={() => dataset.refetch()} />
      ) : (
        <div className="dataset-page" role="status" aria-label="Loading the dataset">
          <div className="skeleton dataset-page__loading-title" />
          <div className="skeleton dataset-page__loading-facts" />
        </div>
      )}
      <UploadPanel />
    </PageFrame>
  );
}
