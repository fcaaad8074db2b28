import { Link } from "react-router";
import type { Status } from "../../api/status_endpoints";
import { ColumnHeads } from "../../design/column_heads";
import { formatDate, sentence } from "../../design/format";
import { TableScroll } from "../../design/table_scroll";

/** What failed lately, with the way to where it can be mended. */
export function FailuresSection({ failures }: { failures: Status["failures"] }) {
  return (
    <section className="section card" aria-labelledby="failures-title">
      <h2 id="failures-title">Failures</h2>
      {failures.length === 0 ? (
        <p className="muted">None.</p>
      ) : (
        <TableScroll label="Latest failures">
          <table className="table">
            <ColumnHeads columns={["When", "What", "Why"]} />
            <tbody>
              {failures.map(({ kind, id, what, page, at, error }) => (
                <tr key={`${kind}-${id}`}>
                  <td className="status__time">{at === null ? "–" : formatDate(at)}</td>
                  <th scope="row" className="status__what">
                    <Link to={page} title={what}>
                      {what}
                    </Link>
                    <span className="table__small">{kind}</span>
                  </th>
                  <td className="status__why">
                    {sentence(error.message)}
                    {error.hint ? <span className="table__small"> {sentence(error.hint)}</span> : null}
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        </TableScroll>
      )}
    </section>
  );
}
