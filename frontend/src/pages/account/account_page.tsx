import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { accountQuery } from "../../api/account_queries";
import { meQuery } from "../../api/board_queries";
import { Badge } from "../../design/badge";
import { buttonClass } from "../../design/button";
import { formatDay } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { MAY } from "../../design/roles";
import { EmptyState } from "../../design/states";
import { Fetched, PageSkeleton } from "../fetched";
import { EmailSection } from "./email_section";
import { IdentitiesSection } from "./identities_section";
import { OwnTokensSection } from "./own_tokens_section";
import { PasswordSection } from "./password_section";
import { SessionsSection } from "./sessions_section";
import "../board_page.css";
import "./account.css";

/** One's own account: password, browsers that are signed in, tokens for programs. */
export function AccountPage() {
  const me = useQuery(meQuery);
  return (
    <PageFrame crumbs={[{ label: "Account" }]}>
      {me.data && me.data.account === null ? (
        <NoAccount anonymous={me.data.anonymous} hosted={me.data.hosted} />
      ) : me.data ? (
        <Account />
      ) : (
        <PageSkeleton what="the account" />
      )}
    </PageFrame>
  );
}

function NoAccount({ anonymous, hosted }: { anonymous: boolean; hosted: boolean }) {
  return (
    <EmptyState
      icon="person"
      title={anonymous && hosted ? "You aren't signed in" : "There is no account here"}
      actions={
        hosted ? (
          <Link to="/sign-in?next=/account" className={buttonClass("primary")}>
            Sign in
          </Link>
        ) : null
      }
    >
      {hosted
        ? anonymous
          ? "Sign in to see your account."
          : "You are signed in with a service token, which has neither password nor sessions."
        : "This server answers on this computer alone, where nobody needs to sign in."}
    </EmptyState>
  );
}

function Account() {
  const account = useQuery(accountQuery);
  return (
    <Fetched
      query={account}
      missing={<NoAccount anonymous hosted />}
      loading={<PageSkeleton what="the account" />}
    >
      {(data) => (
        <div className="board-page account-page">
          <header className="board-page__title">
            <h1>{data.name}</h1>
            <div className="board-page__facts">
              <Badge tone="accent">{data.role}</Badge>
              <span className="muted">
                {MAY[data.role]} Since {formatDay(data.created_at)}.
              </span>
            </div>
          </header>
          <PasswordSection account={data} />
          <EmailSection account={data} />
          <IdentitiesSection account={data} />
          <SessionsSection />
          <OwnTokensSection account={data} />
        </div>
      )}
    </Fetched>
  );
}
