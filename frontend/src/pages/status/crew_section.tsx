import type { Status } from "../../api/status_endpoints";
import { Badge } from "../../design/badge";
import { ColumnHeads, numbers } from "../../design/column_heads";
import { formatBytes, formatDate, formatQuantity } from "../../design/format";
import { TableScroll } from "../../design/table_scroll";

const MEBIBYTE = 2 ** 20;

export function CrewSection({ crew, dispatcher }: Pick<Status, "crew" | "dispatcher">) {
  return (
    <section className="section card" aria-labelledby="crew-title">
      <header className="section__header">
        <h2 id="crew-title">Workers</h2>
        <span className="muted">
          {crew.kind === "pool"
            ? "Processes on this machine, started when there is work"
            : `A Dask cluster at ${crew.address ?? "an unknown address"}`}
        </span>
      </header>
      <p className="muted">{dispatcherText(dispatcher)}</p>
      {crew.workers.length === 0 ? (
        <p className="muted">
          {crew.kind === "pool" ? "None are running: there is nothing to do." : "None have joined."}
        </p>
      ) : (
        <TableScroll label="Workers">
          <table className="table">
            <ColumnHeads columns={["Worker", "Address", numbers("Memory"), "State"]} />
            <tbody>
              {crew.workers.map(({ name, address, accepted, reason, megabytes, busy }) => (
                <tr key={`${name} ${address}`}>
                  <th scope="row">{name}</th>
                  <td className="mono">{address}</td>
                  <td className="table__number">
                    {megabytes === null ? "–" : formatBytes(megabytes * MEBIBYTE)}
                  </td>
                  <td>
                    {accepted ? (
                      <Badge tone={busy ? "accent" : "neutral"}>{busy ? "Busy" : "Idle"}</Badge>
                    ) : (
                      <>
                        <Badge tone="danger">Refused</Badge> <span className="table__small">{reason}</span>
                      </>
                    )}
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

function dispatcherText({ here, held, holder, since, running, in_hand }: Status["dispatcher"]): string {
  const time = since === null ? "" : ` since ${formatDate(since)}`;
  if (here) {
    const next = in_hand > 0 ? `, ${formatQuantity(in_hand, "piece")} next` : "";
    return `This server gives work out${time}: ${formatQuantity(running, "piece")} running${next}.`;
  }
  if (held === false) return "No server gives work out now.";
  return `Another server gives work out${time}${holder === null ? "" : `, from ${holder}`}.`;
}
