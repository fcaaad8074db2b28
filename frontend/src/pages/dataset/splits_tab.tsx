import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { splitsQuery } from "../../api/board_queries";
import type { Dataset } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { EmptyState, ErrorState } from "../../design/states";
import { SplitCard } from "../splits/split_card";
import { FreezePanel } from "./freeze_panel";
import { SplitMenu } from "./split_menu";
import "./splits_tab.css";

/** The splits that were frozen from a dataset, and the place to freeze one. */
export function SplitsTab({ dataset }: { dataset: Dataset }) {
  const splits = useQuery(splitsQuery);
  const [freezing, setFreezing] = useState(false);
  const { maintain: maintains } = useRights();
  if (splits.isError) return <ErrorState error={splits.error} onRetry={() => splits.refetch()} />;
  if (!splits.data) {
    return <div className="skeleton splits-tab__loading" role="status" aria-label="Loading splits" />;
  }
  const own = splits.data.filter((split) => split.dataset?.slug === dataset.slug);
  const freeze = maintains ? (
    <Button tone="primary" icon="snow" onClick={() => setFreezing(true)}>
      Freeze a split
    </Button>
  ) : null;
  return (
    <div className="splits-tab">
      {freezing ? <FreezePanel dataset={dataset} close={() => setFreezing(false)} /> : null}
      {own.length === 0 && !freezing ? (
        <EmptyState icon="snow" title="No splits yet" actions={freeze}>
          A split is a frozen copy of the labels of images that are done. Detectors are scored on it; what is
          labelled later changes no score.
        </EmptyState>
      ) : null}
      {own.length > 0 ? (
        <>
          {freezing ? null : <div className="splits-tab__tools">{freeze}</div>}
          <ul className="split-cards">
            {own.map((split) => (
              <SplitCard
                key={split.slug}
                split={split}
                tools={split.can.maintain ? <SplitMenu split={split} /> : null}
              />
            ))}
          </ul>
        </>
      ) : null}
    </div>
  );
}
