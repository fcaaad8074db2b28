import { Link } from "react-router";
import type { AuditEntry } from "../../api/account_types";
import { ColumnHeads } from "../../design/column_heads";
import { formatDate } from "../../design/format";
import { TableScroll } from "../../design/table_scroll";
import { detailText, kindText } from "./audit_text";

export function AuditTable({ entries }: { entries: readonly AuditEntry[] }) {
  return (
    <TableScroll label="Audit">
      <table className="table">
        <ColumnHeads columns={["When", "Who", "What", "Dataset", "Details"]} />
        <tbody>
          {entries.map(({ id, created_at, person, address, kind, dataset, details }) => (
            <tr key={id}>
              <td className="audit__time">
                <time dateTime={created_at} title={created_at}>
                  {formatDate(created_at)}
                </time>
              </td>
              <td className="audit__person" title={address ?? undefined}>
                {person ?? <span className="muted">nobody</span>}
                {address ? <span className="table__small mono"> {address}</span> : null}
              </td>
              <th scope="row" className="audit__kind">
                {kindText(kind)}
              </th>
              <td>{dataset ? <Link to={`/datasets/${dataset}`}>{dataset}</Link> : null}</td>
              <td className="audit__details">{detailText(details)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </TableScroll>
  );
}
