import type { UseQueryResult } from "@tanstack/react-query";
import type { ReactNode } from "react";
import { Link } from "react-router";
import { asProblem } from "../api/problem";
import { buttonClass } from "../design/button";
import { EmptyState, ErrorState } from "../design/states";

interface FetchedProps<Data> {
  query: UseQueryResult<Data>;
  /** In place of what doesn't exist, or isn't for this person. */
  missing: ReactNode;
  loading: ReactNode;
  children: (data: Data) => ReactNode;
}

/** A page's content once it is there. */
export function Fetched<Data>({ query, missing, loading, children }: FetchedProps<Data>) {
  if (query.isError && asProblem(query.error).status === 404) return missing;
  if (query.data !== undefined) return children(query.data);
  if (query.isError) return <ErrorState error={query.error} onRetry={() => query.refetch()} />;
  return loading;
}

interface MissingProps {
  /** "There is no such …". */
  what: string;
  /** The list of those that exist. */
  list: { to: string; label: string };
  children?: ReactNode;
}

export function Missing({ what, list, children }: MissingProps) {
  return (
    <EmptyState
      icon="search"
      title={`There is no such ${what}`}
      actions={
        <Link to={list.to} className={buttonClass("primary")}>
          {list.label}
        </Link>
      }
    >
      {children}
    </EmptyState>
  );
}

export const ALL_DATASETS = { to: "/", label: "All datasets" };
export const ALL_LEADERBOARDS = { to: "/splits", label: "All leaderboards" };

/** @param what As in "Loading the card". */
export function PageSkeleton({ what }: { what: string }) {
  return (
    <div className="board-page" role="status" aria-label={`Loading ${what}`}>
      <div className="skeleton board-page__loading" />
    </div>
  );
}
