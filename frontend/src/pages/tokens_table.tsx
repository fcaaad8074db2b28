import type { OwnToken } from "../api/account_types";
import { Button } from "../design/button";
import { ColumnHeads } from "../design/column_heads";
import { formatDay } from "../design/format";
import { TableScroll } from "../design/table_scroll";
import "./tokens_table.css";

interface Row extends Omit<OwnToken, "label"> {
  label: string | null;
  /** Whose it is, where that isn't plain. */
  name?: string;
}

interface TokensTableProps {
  label: string;
  tokens: readonly Row[];
  revoke: (id: number) => void;
}

/** Tokens that are good, with what they may do and when they were used. */
export function TokensTable({ label, tokens, revoke }: TokensTableProps) {
  const named = tokens.some(({ name }) => name !== undefined);
  const heads = ["Label", "Role", "Made", "Expires", "Last used", ""];
  return (
    <TableScroll label={label}>
      <table className="table">
        <ColumnHeads columns={named ? ["Name", ...heads] : heads} />
        <tbody>
          {tokens.map(({ id, name, label: what, role, created_at, expires_at, last_used_at }) => (
            <tr key={id}>
              {named ? (
                <th scope="row" className="tokens-table__name" title={name}>
                  {name}
                </th>
              ) : null}
              <td className="tokens-table__name" title={what ?? undefined}>
                {what ?? "service"}
              </td>
              <td>{role}</td>
              <td>{formatDay(created_at)}</td>
              <td>{expires_at ? formatDay(expires_at) : "never"}</td>
              <td>{last_used_at ? formatDay(last_used_at) : "never"}</td>
              <td className="table__number">
                <Button small tone="danger" onClick={() => revoke(id)}>
                  Revoke
                </Button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </TableScroll>
  );
}
