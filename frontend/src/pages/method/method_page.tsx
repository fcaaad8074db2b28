import { useQuery } from "@tanstack/react-query";
import { useParams } from "react-router";
import { methodQuery } from "../../api/board_queries";
import { PageFrame } from "../../design/page_frame";
import { ALL_LEADERBOARDS, Fetched, Missing, PageSkeleton } from "../fetched";
import { MethodView } from "./method_view";
import "../board_page.css";
import "./method.css";

/** A method: what it is, and how its versions did. */
export function MethodPage() {
  const { slug = "" } = useParams();
  const method = useQuery(methodQuery(slug));
  return (
    <PageFrame crumbs={[{ label: "Leaderboards", to: "/splits" }, { label: method.data?.name ?? slug }]}>
      <Fetched
        query={method}
        missing={
          <Missing what="method" list={ALL_LEADERBOARDS}>
            The address may be mistyped, or everything submitted for it is private.
          </Missing>
        }
        loading={<PageSkeleton what="the method" />}
      >
        {(data) => <MethodView key={slug} method={data} />}
      </Fetched>
    </PageFrame>
  );
}
