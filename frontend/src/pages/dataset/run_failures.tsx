import { useInfiniteQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { listRunImages } from "../../api/endpoints";
import type { Run } from "../../api/types";
import { Button } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatQuantity, sentence } from "../../design/format";

/** The images of a run that failed, each with its reason. */
export function RunFailures({ slug, run }: { slug: string; run: Run }) {
  const failures = useInfiniteQuery({
    queryKey: ["runs", run.id, "failed", run.counts.failed],
    queryFn: ({ pageParam }) => listRunImages(run.id, "failed", pageParam),
    initialPageParam: null as string | null,
    getNextPageParam: (last) => last.next_cursor,
  });
  const entries = failures.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <details className="run-failures" open>
      <summary className="numeric">{formatQuantity(run.counts.failed, "image")} failed</summary>
      <ul>
        {entries.map(({ image, error, attempts }) => (
          <li key={image.id}>
            <Link to={`/datasets/${slug}/images/${image.id}`}>
              <Ellipsis text={image.name} end={14} />
            </Link>
            <span>
              {sentence(error?.message ?? "No reason was given")}
              {error?.hint ? <span className="muted"> {sentence(error.hint)}</span> : null}
              {attempts > 1 ? <span className="muted numeric"> ({attempts} attempts)</span> : null}
            </span>
          </li>
        ))}
      </ul>
      {failures.hasNextPage ? (
        <Button small busy={failures.isFetchingNextPage} onClick={() => failures.fetchNextPage()}>
          Show more
        </Button>
      ) : null}
    </details>
  );
}
