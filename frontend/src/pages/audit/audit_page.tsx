import { useInfiniteQuery } from "@tanstack/react-query";
import { auditQuery } from "../../api/account_queries";
import { Button } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { AdminsOnly } from "../admins_only";
import { PageSkeleton } from "../fetched";
import { AuditFilters } from "./audit_filters";
import { AuditTable } from "./audit_table";
import { useAuditFilter } from "./use_audit_filter";
import "../board_page.css";
import "./audit.css";

/** Who did what, newest first. The filter is in the address, so a view of it can be shared. */
export function AuditPage() {
  return (
    <PageFrame crumbs={[{ label: "Audit" }]}>
      <AdminsOnly what="read the audit">
        <Audit />
      </AdminsOnly>
    </PageFrame>
  );
}

function Audit() {
  const { filter, change, clear, any } = useAuditFilter();
  const audit = useInfiniteQuery(auditQuery(filter));
  const entries = audit.data?.pages.flatMap(({ items }) => items) ?? [];
  return (
    <div className="board-page">
      <header className="board-page__title">
        <h1>Audit</h1>
        <p className="muted">
          Who did what, newest first; lines are only ever added. Verdicts have a history of their own, with
          each image.
        </p>
      </header>
      <section className="section card" aria-label="Audit">
        <AuditFilters filter={filter} change={change} clear={any ? clear : null} />
        {audit.isPending ? (
          <PageSkeleton what="the audit" />
        ) : audit.isError ? (
          <ErrorState error={audit.error} onRetry={() => audit.refetch()} />
        ) : entries.length === 0 ? (
          <EmptyState icon="search" title={any ? "Nothing like that" : "Nothing happened yet"} />
        ) : (
          <>
            <AuditTable entries={entries} />
            {audit.hasNextPage ? (
              <div className="board-page__actions">
                <Button busy={audit.isFetchingNextPage} onClick={() => void audit.fetchNextPage()}>
                  Show older
                </Button>
              </div>
            ) : null}
          </>
        )}
      </section>
    </div>
  );
}
