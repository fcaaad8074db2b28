import { useQuery } from "@tanstack/react-query";
import { useParams } from "react-router";
import { datasetQuery, datasetSuggestionsQuery } from "../../api/queries";
import { PageFrame } from "../../design/page_frame";
import { ALL_DATASETS, Fetched, Missing, PageSkeleton } from "../fetched";
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
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.data?.name ?? slug, to: `/datasets/${slug}` },
        { label: "Suggestions" },
      ]}
    >
      <Fetched
        query={suggestions}
        missing={<Missing what="dataset" list={ALL_DATASETS} />}
        loading={<PageSkeleton what="the suggestions" />}
      >
        {(data) => <SuggestionsView slug={slug} suggestions={data} />}
      </Fetched>
    </PageFrame>
  );
}
