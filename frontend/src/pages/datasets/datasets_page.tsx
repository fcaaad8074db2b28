import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { listDatasets } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { PageFrame } from "../../design/page_frame";
import { ErrorState, LoadingState } from "../../design/states";

export function DatasetsPage() {
  const datasets = useQuery({ queryKey: keys.datasets, queryFn: () => listDatasets() });
  return (
    <PageFrame crumbs={[{ label: "Datasets" }]}>
      {datasets.isPending ? <LoadingState label="Loading datasets" /> : null}
      {datasets.isError ? <ErrorState error={datasets.error} onRetry={() => datasets.refetch()} /> : null}
      <ul>
        {datasets.data?.map((dataset) => (
          <li key={dataset.slug}>
            <Link to={`/datasets/${dataset.slug}`}>{dataset.name}</Link>
          </li>
        ))}
      </ul>
    </PageFrame>
  );
}
