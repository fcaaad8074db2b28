import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { cardQuery } from "../../api/board_queries";
import { asProblem } from "../../api/problem";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { CardView } from "./card_view";
import "../board_page.css";
import "./card.css";

/** A dataset as it is presented to those who want to use it; made to be printed too. */
export function CardPage() {
  const { slug = "" } = useParams();
  const card = useQuery(cardQuery(slug));
  const missing = card.isError && asProblem(card.error).status === 404;
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: card.data?.name ?? slug, to: `/datasets/${slug}` },
        { label: "Card" },
      ]}
    >
      {card.data && !missing ? (
        <CardView slug={slug} card={card.data} />
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
      ) : card.isError ? (
        <ErrorState error={card.error} onRetry={() => card.refetch()} />
      ) : (
        <div className="board-page" role="status" aria-label="Loading the card">
          <div className="skeleton board-page__loading" />
        </div>
      )}
    </PageFrame>
  );
}
