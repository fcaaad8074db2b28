import { useQuery } from "@tanstack/react-query";
import { useParams } from "react-router";
import { cardQuery } from "../../api/board_queries";
import { PageFrame } from "../../design/page_frame";
import { ALL_DATASETS, Fetched, Missing, PageSkeleton } from "../fetched";
import { CardView } from "./card_view";
import "../board_page.css";
import "./card.css";

/** A dataset as it is presented to those who want to use it; made to be printed too. */
export function CardPage() {
  const { slug = "" } = useParams();
  const card = useQuery(cardQuery(slug));
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: card.data?.name ?? slug, to: `/datasets/${slug}` },
        { label: "Card" },
      ]}
    >
      <Fetched
        query={card}
        missing={<Missing what="dataset" list={ALL_DATASETS} />}
        loading={<PageSkeleton what="the card" />}
      >
        {(data) => <CardView slug={slug} card={data} />}
      </Fetched>
    </PageFrame>
  );
}
