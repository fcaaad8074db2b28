import { Link, useRouteError } from "react-router";
import { buttonClass } from "../design/button";
import { PageFrame } from "../design/page_frame";
import { EmptyState, ErrorState } from "../design/states";

export function NotFoundPage() {
  return (
    <PageFrame crumbs={[{ label: "Page not found" }]}>
      <EmptyState
        icon="search"
        title="There is no such page"
        actions={
          <Link to="/" className={buttonClass("primary")}>
            All datasets
          </Link>
        }
      >
        The address may be mistyped, or what it showed was deleted.
      </EmptyState>
    </PageFrame>
  );
}

/** What a page shows when its own code failed: a chunk that didn't load, or a defect. */
export function PageFailed() {
  const error = useRouteError();
  return (
    <PageFrame crumbs={[{ label: "Something went wrong" }]}>
      <ErrorState error={error} onRetry={() => window.location.reload()} />
    </PageFrame>
  );
}
