import { useQuery } from "@tanstack/react-query";
import { useRef } from "react";
import { Link } from "react-router";
import { splitsQuery } from "../../api/board_queries";
import { buttonClass } from "../../design/button";
import { formatQuantity } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { useArrowKeys } from "../use_arrow_keys";
import { SplitCard } from "./split_card";
import "../board_page.css";

/** All splits that there is a board for. */
export function SplitsPage() {
  const splits = useQuery(splitsQuery);
  const list = useRef<HTMLUListElement>(null);
  useArrowKeys(list, ".split-card__link");
  return (
    <PageFrame crumbs={[{ label: "Leaderboards" }]}>
      <div className="board-page">
        {splits.data ? (
          splits.data.length === 0 ? (
            <NoSplits />
          ) : (
            <>
              <header className="board-page__title">
                <h1>Leaderboards</h1>
                <p className="muted">
                  {formatQuantity(splits.data.length, "split")}: frozen ground truth that detectors are scored
                  on. <Link to="/docs/scoring">How results are scored</Link>
                </p>
              </header>
              <ul ref={list} className="split-cards">
                {splits.data.map((split) => (
                  <SplitCard key={split.slug} split={split} />
                ))}
              </ul>
            </>
          )
        ) : splits.isError ? (
          <ErrorState error={splits.error} onRetry={() => splits.refetch()} />
        ) : (
          <div className="skeleton board-page__loading" role="status" aria-label="Loading the splits" />
        )}
      </div>
    </PageFrame>
  );
}

function NoSplits() {
  return (
    <EmptyState
      icon="podium"
      title="No splits yet"
      actions={
        <Link to="/" className={buttonClass("primary")}>
          All datasets
        </Link>
      }
    >
      A split is part of a dataset whose labels are frozen, so that every detector is scored on the same
      truth. Open a dataset whose images are done, and freeze one under <strong>Splits</strong>.
    </EmptyState>
  );
}
