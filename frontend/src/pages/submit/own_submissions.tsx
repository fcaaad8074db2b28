import type { Split } from "../../api/board_types";
import { Button } from "../../design/button";
import { formatCount } from "../../design/format";
import { ErrorState } from "../../design/states";
import { SubmissionTable } from "../submission_table";
import { useOwnSubmissions } from "./use_own_submissions";

/** One's own submissions to a split. */
export function OwnSubmissions({ split }: { split: Split }) {
  const own = useOwnSubmissions(split.slug);
  const items = own.data?.pages.flatMap((page) => page.items) ?? [];
  if (own.isError) {
    return <ErrorState error={own.error} onRetry={() => own.refetch()} />;
  }
  if (items.length === 0) return null;
  return (
    <section className="section card" aria-labelledby="own-title">
      <h2 id="own-title">
        Your submissions{" "}
        <span className="tabs__count">{formatCount(own.data?.pages[0]?.total ?? items.length)}</span>
      </h2>
      <SubmissionTable submissions={items} withMethod />
      {own.hasNextPage ? (
        <Button busy={own.isFetchingNextPage} onClick={() => own.fetchNextPage()}>
          Show more
        </Button>
      ) : null}
    </section>
  );
}
