import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { methodQuery } from "../../api/board_queries";
import { asProblem } from "../../api/problem";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { MethodView } from "./method_view";
import "../board_page.css";
import "./method.css";

/** A method: what it is, and how its versions did. */
export function MethodPage() {
  const { slug = "" } = useParams();
  const method = useQuery(methodQuery(slug));
  const missing = method.isError && asProblem(method.error).status === 404;
  return (
    <PageFrame crumbs={[{ label: "Leaderboards", to: "/splits" }, { label: method.data?.name ?? slug }]}>
      {method.data && !missing ? (
        <MethodView key={slug} method={method.data} />
      ) : missing ? (
        <EmptyState
          icon="search"
          title="There is no such method"
          actions={
            <Link to="/splits" className={buttonClass("primary")}>
              All leaderboards
            </Link>
          }
        >
          The address may be mistyped, or everything submitted for it is private.
        </EmptyState>
      ) : method.isError ? (
        <ErrorState error={method.error} onRetry={() => method.refetch()} />
      ) : (
        <div className="board-page" role="status" aria-label="Loading the method">
          <div className="skeleton board-page__loading" />
        </div>
      )}
    </PageFrame>
  );
}
