import { useQuery } from "@tanstack/react-query";
import type { ReactNode } from "react";
import { Link, useLocation } from "react-router";
import { meQuery } from "../api/board_queries";
import { buttonClass } from "../design/button";
import { EmptyState } from "../design/states";
import { PageSkeleton } from "./fetched";

/** Pages for administrators; who isn't one is told so, and where to sign in. */
export function AdminsOnly({ what, children }: { what: string; children: ReactNode }) {
  const me = useQuery(meQuery);
  const { pathname, search } = useLocation();
  if (!me.data) return <PageSkeleton what="the page" />;
  if (me.data.can.admin) return children;
  return (
    <EmptyState
      icon="lock"
      title={`Only administrators ${what}`}
      actions={
        me.data.anonymous ? (
          <Link
            to={`/sign-in?next=${encodeURIComponent(pathname + search)}`}
            className={buttonClass("primary")}
          >
            Sign in
          </Link>
        ) : (
          <Link to="/" className={buttonClass("primary")}>
            All datasets
          </Link>
        )
      }
    >
      {me.data.anonymous ? "Nobody is signed in here." : `You are ${me.data.name}, ${me.data.role}.`}
    </EmptyState>
  );
}
