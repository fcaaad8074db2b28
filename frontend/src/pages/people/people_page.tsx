import { useQuery } from "@tanstack/react-query";
import { invitationsQuery, serviceTokensQuery, usersQuery } from "../../api/account_queries";
import { formatQuantity } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { AdminsOnly } from "../admins_only";
import { Fetched, PageSkeleton } from "../fetched";
import { InvitationsSection } from "./invitations_section";
import { ServiceTokensSection } from "./service_tokens_section";
import { UsersSection } from "./users_section";
import "../board_page.css";
import "./people.css";

/** Everyone who may sign in: accounts, invitations on their way, and tokens of services. */
export function PeoplePage() {
  return (
    <PageFrame crumbs={[{ label: "People" }]}>
      <AdminsOnly what="manage accounts">
        <People />
      </AdminsOnly>
    </PageFrame>
  );
}

function People() {
  const users = useQuery(usersQuery);
  const invitations = useQuery(invitationsQuery);
  const tokens = useQuery(serviceTokensQuery);
  return (
    <div className="board-page">
      <header className="board-page__title">
        <h1>People</h1>
        <p className="muted numeric">
          {users.data ? formatQuantity(users.data.length, "account") : "Accounts"}; what somebody did stays
          under their name when the account is disabled.
        </p>
      </header>
      <Fetched query={users} missing={null} loading={<PageSkeleton what="the accounts" />}>
        {(data) => <UsersSection users={data} />}
      </Fetched>
      <Fetched query={invitations} missing={null} loading={<PageSkeleton what="the invitations" />}>
        {(data) => <InvitationsSection invitations={data} />}
      </Fetched>
      <Fetched query={tokens} missing={null} loading={<PageSkeleton what="the tokens" />}>
        {(data) => <ServiceTokensSection tokens={data.filter(({ revoked_at }) => revoked_at === null)} />}
      </Fetched>
    </div>
  );
}
