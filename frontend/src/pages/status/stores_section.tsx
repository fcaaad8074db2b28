import type { Status } from "../../api/status_endpoints";
import { capitalized, formatBytes } from "../../design/format";

export function StoresSection({ disks, database }: Pick<Status, "disks" | "database">) {
  const { kind, version, address, bytes, revision, connections, connections_used } = database;
  return (
    <section className="section card" aria-labelledby="stores-title">
      <h2 id="stores-title">Storage</h2>
      <dl className="status__stores">
        {disks.map((disk) => (
          <div key={disk.name}>
            <dt>{capitalized(disk.name)}</dt>
            <dd>
              <span className="mono status__address">{disk.address}</span>
              <DiskSpace disk={disk} />
            </dd>
          </div>
        ))}
        <div>
          <dt>Database</dt>
          <dd>
            <span className="mono status__address">{address}</span>
            <span className="muted">
              {kind} {version}, {formatBytes(bytes)}, tables of revision {revision ?? "unknown"},{" "}
              {connections_used} of {connections} connections in use
            </span>
          </dd>
        </div>
      </dl>
    </section>
  );
}

function DiskSpace({ disk: { used, free, problem } }: { disk: Status["disks"][number] }) {
  if (problem !== null) return <span className="status__failed">{problem}</span>;
  if (used === null || free === null) return <span className="muted">Nobody can tell how full it is.</span>;
  const share = used / Math.max(1, used + free);
  return (
    <span className="status__space">
      <span className="status__bar" aria-hidden="true">
        <span
          className={share > 0.9 ? "status__fill status__fill--full" : "status__fill"}
          style={{ width: `${100 * share}%` }}
        />
      </span>
      <span className="muted numeric">
        {formatBytes(free)} of {formatBytes(used + free)} free
      </span>
    </span>
  );
}
