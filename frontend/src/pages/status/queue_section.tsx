import type { Status } from "../../api/status_endpoints";
import { ColumnHeads, numbers } from "../../design/column_heads";
import { capitalized, formatCount, formatDuration } from "../../design/format";
import { TableScroll } from "../../design/table_scroll";

export function QueueSection({ queue }: { queue: Status["queue"] }) {
  return (
    <section className="section card" aria-labelledby="queue-title">
      <h2 id="queue-title">Work</h2>
      <TableScroll label="Work by kind">
        <table className="table">
          <ColumnHeads
            columns={[
              "Kind",
              numbers("Waiting"),
              numbers("Oldest waits for"),
              numbers("Running"),
              numbers("Failed in a day"),
            ]}
          />
          <tbody>
            {queue.map(({ kind, waiting, running, failed, oldest_wait }) => (
              <tr key={kind}>
                <th scope="row">{capitalized(kind)}</th>
                <td className="table__number">{formatCount(waiting)}</td>
                <td className="table__number">{oldest_wait === null ? "–" : formatDuration(oldest_wait)}</td>
                <td className="table__number">{formatCount(running)}</td>
                <td className={`table__number${failed > 0 ? " status__failed" : ""}`}>
                  {formatCount(failed)}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
    </section>
  );
}
