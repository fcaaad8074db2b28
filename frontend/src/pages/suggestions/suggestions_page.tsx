import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { asProblem } from "../../api/problem";
import { datasetQuery, datasetSuggestionsQuery } from "../../api/queries";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { SuggestionsView } from "./suggestions_view";
import "../board_page.css";
import "./suggestions_page.css";

/** How often it is asked whether a training is done (ms). */
const POLL = 1_000;

/** The model that suggests in a dataset: what it was learnt from, and how good it is. */
export function SuggestionsPage() {
  const { slug = "" } = useParams();
  const dataset = useQuery(datasetQuery(slug));
  const suggestions = useQuery({
    ...datasetSuggestionsQuery(slug),
    refetchInterval: ({ state }) => (state.data?.training.asked ? POLL : false),
  });
  const missing = suggestions.isError && asProblem(suggestions.error).status === 404;
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.data?.name ?? slug, to: `/datasets/${slug}` },
        { label: "Suggestions" },
      ]}
    >
      {suggestions.data && !missing ? (
        <SuggestionsView slug={slug} suggestions={suggestions.data} />
      ) : missing ? (
        <EmptyState
          icon="search"
          title="There is no such dataset"
          actions={
            <Link to="/" className={buttonClass("primary")}>
              All datasets
            </Link>
          }
        />
      ) : suggestions.isError ? (
        <ErrorState error={suggestions.error} onRetry={() => suggestions.refetch()} />
      ) : (
        <div className="board-page" role="status" aria-label="Loading the suggestions">
          <div className="skeleton board-page__loading" />
        </div>
      )}
    </PageFrame>
  );
}
