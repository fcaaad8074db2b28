import { useQuery } from "@tanstack/react-query";
import { endSession } from "../../api/account_endpoints";
import { accountKeys, sessionsQuery } from "../../api/account_queries";
import { Badge } from "../../design/badge";
import { Button } from "../../design/button";
import { ColumnHeads } from "../../design/column_heads";
import { formatDate } from "../../design/format";
import { LoadingState } from "../../design/states";
import { TableScroll } from "../../design/table_scroll";
import { Fetched } from "../fetched";
import { useFollowed } from "../use_followed";
import { browserName } from "./browser_name";

/** Browsers that are signed in to the account. */
export function SessionsSection() {
  const sessions = useQuery(sessionsQuery);
  const follow = useFollowed(accountKeys.sessions);
  return (
    <section className="section card" aria-labelledby="sessions-title">
      <h2 id="sessions-title">Signed in</h2>
      <Fetched query={sessions} missing={null} loading={<LoadingState label="Loading" />}>
        {(data) => (
          <TableScroll label="Browsers that are signed in">
            <table className="table">
              <ColumnHeads columns={["Browser", "Address", "Since", "Last seen", ""]} />
              <tbody>
                {data.map(({ id, agent, address, created_at, last_used_at, current }) => (
                  <tr key={id}>
                    <th scope="row" className="account-page__agent" title={agent ?? undefined}>
                      {browserName(agent)} {current ? <Badge tone="success">This one</Badge> : null}
                    </th>
                    <td className="mono">{address ?? "–"}</td>
                    <td>{formatDate(created_at)}</td>
                    <td>{formatDate(last_used_at)}</td>
                    <td className="table__number">
                      {current ? null : (
                        <Button small onClick={() => void follow(() => endSession(id))}>
                          Sign out
                        </Button>
                      )}
                    </td>
                  </tr>
                ))}
              </tbody>
            </table>
          </TableScroll>
        )}
      </Fetched>
    </section>
  );
}
