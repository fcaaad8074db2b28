import { useQuery } from "@tanstack/react-query";
import { useParams } from "react-router";
import { datasetQuery } from "../../api/queries";
import { PageFrame } from "../../design/page_frame";
import { UploadPanel } from "../../uploads/upload_panel";
import { useRefreshAfterUploads } from "../../uploads/use_uploads";
import { ALL_DATASETS, Fetched, Missing } from "../fetched";
import { DatasetView } from "./dataset_view";
import "./dataset.css";

/** One dataset: its images, runs and cameras. */
export function DatasetPage() {
  const { slug = "" } = useParams();
  const dataset = useQuery({ ...datasetQuery(slug), refetchOnMount: "always" });
  useRefreshAfterUploads();
  return (
    <PageFrame crumbs={[{ label: "Datasets", to: "/" }, { label: dataset.data?.name ?? slug }]}>
      <Fetched
        query={dataset}
        missing={
          <Missing what="dataset" list={ALL_DATASETS}>
            It may have been deleted; what was deleted lately can be restored on the page of all datasets.
          </Missing>
        }
        loading={
          <div className="dataset-page" role="status" aria-label="Loading the dataset">
            <div className="skeleton dataset-page__loading-title" />
            <div className="skeleton dataset-page__loading-facts" />
          </div>
        }
      >
        {(data) => <DatasetView key={slug} dataset={data} />}
      </Fetched>
      <UploadPanel />
    </PageFrame>
  );
}
