import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { splitQuery } from "../../api/board_queries";
import { asProblem } from "../../api/problem";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { BoardView } from "./board_view";
import "../board_page.css";
import "./board.css";

/** The leaderboard of a split. */
export function BoardPage() {
  const { split: slug = "" } = useParams();
  const split = useQuery(splitQuery(slug));
  const missing = split.isError && asProblem(split.error).status === 404;
  return (
    <PageFrame crumbs={[{ label: "Leaderboards", to: "/splits" }, { label: split.data?.name ?? slug }]}>
      {split.data && !missing ? (
        <BoardView key={slug} split={split.data} />
      ) : missing ? (
        <NoSuchSplit />
      ) : split.isError ? (
        <ErrorState error={split.error} onRetry={() => split.refetch()} />
      ) : (
        <div className="board-page" role="status" aria-label="Loading the leaderboard">
          <div className="skeleton board-page__loading" />
        </div>
      )}
    </PageFrame>
  );
}

export function NoSuchSplit() {
  return (
    <EmptyState
      icon="search"
      title="There is no such split"
      actions={
        <Link to="/splits" className={buttonClass("primary")}>
          All leaderboards
        </Link>
      }
    >
      The address may be mistyped, or the split was deleted.
    </EmptyState>
  );
}
