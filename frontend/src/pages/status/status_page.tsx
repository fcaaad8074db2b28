import { useQuery } from "@tanstack/react-query";
import { type Status, statusQuery } from "../../api/status_endpoints";
import { formatDate } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { AdminsOnly } from "../admins_only";
import { Fetched, PageSkeleton } from "../fetched";
import { Note } from "../note";
import { CrewSection } from "./crew_section";
import { FailuresSection } from "./failures_section";
import { QueueSection } from "./queue_section";
import { StoresSection } from "./stores_section";
import { troublesOf } from "./troubles";
import "../board_page.css";
import "./status.css";

/** How the server is: what waits, who works, what failed, how full the disks are. Renews itself. */
export function StatusPage() {
  return (
    <PageFrame crumbs={[{ label: "Status" }]}>
      <AdminsOnly what="see the state of the server">
        <Shown />
      </AdminsOnly>
    </PageFrame>
  );
}

function Shown() {
  const status = useQuery(statusQuery);
  return (
    <Fetched query={status} missing={null} loading={<PageSkeleton what="the state of the server" />}>
      {(data) => (
        <>
          <StatusView status={data} />
          {status.isError ? (
            <p className="visually-hidden" role="alert">
              The server doesn't answer.
            </p>
          ) : null}
        </>
      )}
    </Fetched>
  );
}

function StatusView({ status }: { status: Status }) {
  const troubles = troublesOf(status);
  return (
    <div className="board-page">
      <header className="board-page__title">
        <h1>Status</h1>
        <p className="muted">
          ClearLines {status.version}, up since {formatDate(status.started_at)}, as of{" "}
          <time dateTime={status.now}>{new Date(status.now).toLocaleTimeString("en")}</time>.
        </p>
      </header>
      {troubles.length === 0 ? (
        <Note icon="check">Everything is as it should be.</Note>
      ) : (
        troubles.map((trouble) => (
          <Note key={trouble} tone="warning">
            {trouble}
          </Note>
        ))
      )}
      <QueueSection queue={status.queue} />
      <CrewSection crew={status.crew} dispatcher={status.dispatcher} />
      <StoresSection disks={status.disks} database={status.database} />
      <FailuresSection failures={status.failures} />
    </div>
  );
}
