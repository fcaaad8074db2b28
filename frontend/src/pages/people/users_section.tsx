import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { Link } from "react-router";
import { resetUser } from "../../api/account_endpoints";
import type { User } from "../../api/account_types";
import { meQuery } from "../../api/board_queries";
import { Badge } from "../../design/badge";
import { ColumnHeads } from "../../design/column_heads";
import { formatDate, formatDay } from "../../design/format";
import { Icon } from "../../design/icons";
import { Popover } from "../../design/popover";
import { RoleOptions } from "../../design/role_options";
import { ShownOnce } from "../../design/shown_once";
import { EmptyState } from "../../design/states";
import { TableScroll } from "../../design/table_scroll";
import { failed } from "../datasets/use_dataset_actions";
import { useUserActions } from "./use_user_actions";

const SEARCH_FROM = 9;

export function UsersSection({ users }: { users: readonly User[] }) {
  const me = useQuery(meQuery).data;
  const [search, setSearch] = useState("");
  const [reset, setReset] = useState<{ name: string; address: string } | null>(null);
  const wanted = search.trim().toLocaleLowerCase();
  const shown = users.filter(({ name, email }) =>
    `${name} ${email ?? ""}`.toLocaleLowerCase().includes(wanted),
  );
  const makeReset = async (user: User) => {
    try {
      setReset({ name: user.name, address: (await resetUser(user.id)).address });
    } catch (error) {
      failed(error);
    }
  };
  return (
    <section className="section card" aria-labelledby="users-title">
      <header className="section__header">
        <h2 id="users-title">Accounts</h2>
        {users.length >= SEARCH_FROM ? (
          <input
            className="input"
            type="search"
            placeholder="Name or e-mail"
            aria-label="Search accounts"
            value={search}
            onChange={(event) => setSearch(event.target.value)}
          />
        ) : null}
      </header>
      {reset ? (
        <ShownOnce
          label={`Link to a new password for ${reset.name}`}
          text={reset.address}
          hint="Send it to them by a way that only they read. It is good once, and shown this once."
          close={() => setReset(null)}
        />
      ) : null}
      {users.length === 0 ? (
        <EmptyState icon="people" title="No accounts yet">
          Invite somebody below, or make one where the server runs: <code>clearlines user create NAME</code>
        </EmptyState>
      ) : shown.length === 0 ? (
        <p className="muted">Nobody of that name.</p>
      ) : (
        <TableScroll label="Accounts" className="people__table">
          <table className="table">
            <ColumnHeads columns={["Name", "E-mail", "Role", "Since", "Last seen", ""]} />
            <tbody>
              {shown.map((user) => (
                <UserRow
                  key={user.id}
                  user={user}
                  own={user.id === me?.account?.id}
                  reset={() => void makeReset(user)}
                />
              ))}
            </tbody>
          </table>
        </TableScroll>
      )}
    </section>
  );
}

function UserRow({ user, own, reset }: { user: User; own: boolean; reset: () => void }) {
  const { setRole, setDisabled } = useUserActions();
  const { name, email, role, created_at, last_seen_at, disabled_at } = user;
  const disabled = disabled_at !== null;
  return (
    <tr className={disabled ? "people__disabled" : undefined}>
      <th scope="row" className="people__name" title={name}>
        {name} {own ? <Badge tone="accent">You</Badge> : null}{" "}
        {disabled ? <Badge tone="warning">Disabled</Badge> : null}
      </th>
      <td className="people__name" title={email ?? undefined}>
        {email ?? "–"}
      </td>
      <td>
        <select
          className="input"
          aria-label={`Role of ${name}`}
          disabled={disabled}
          value={role}
          onChange={(event) => void setRole(user, event.target.value as User["role"])}
        >
          <RoleOptions />
        </select>
      </td>
      <td>{formatDay(created_at)}</td>
      <td>{last_seen_at ? formatDate(last_seen_at) : "never"}</td>
      <td className="table__number">
        <Popover label={`More for ${name}`} icon="more" iconOnly tone="quiet" small>
          {(close) => {
            const act = (run: () => void) => () => {
              close();
              run();
            };
            return (
              <>
                <Link className="menu-item" to={`/audit?person=${encodeURIComponent(name)}`}>
                  <Icon name="clock" /> What they did
                </Link>
                {disabled ? null : (
                  <button type="button" className="menu-item" onClick={act(reset)}>
                    <Icon name="link" /> Link to a new password
                  </button>
                )}
                <button
                  type="button"
                  className={`menu-item${disabled ? "" : " menu-item--danger"}`}
                  onClick={act(() => void setDisabled(user, !disabled))}
                >
                  <Icon name={disabled ? "undo" : "stop"} /> {disabled ? "Let sign in again" : "Disable"}
                </button>
              </>
            );
          }}
        </Popover>
      </td>
    </tr>
  );
}
