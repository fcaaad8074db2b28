import { useQuery } from "@tanstack/react-query";
import { listDatasets } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { Button } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatDate, formatQuantity } from "../../design/format";
import { useDatasetActions } from "./use_dataset_actions";

/** Datasets that can still be restored, and until when. */
export function RecentlyDeleted() {
  const deleted = useQuery({
    queryKey: [...keys.datasets, "deleted"],
    queryFn: () => listDatasets(true),
  });
  const { restore } = useDatasetActions();
  if (!deleted.data || deleted.data.length === 0) return null;
  return (
    <details className="recently-deleted">
      <summary className="numeric">Recently deleted ({deleted.data.length})</summary>
      <ul className="recently-deleted__list card">
        {deleted.data.map((dataset) => (
          <li key={dataset.slug}>
            <Ellipsis text={dataset.name} />
            <span className="muted numeric">
              {formatQuantity(dataset.images, "image")}
              {dataset.restorable_until ? `, until ${formatDate(dataset.restorable_until)}` : null}
            </span>
            <Button small icon="undo" onClick={() => restore(dataset)}>
              Restore
            </Button>
          </li>
        ))}
      </ul>
    </details>
  );
}
