import { useState } from "react";
import { Button, IconButton } from "../design/button";
import { Ellipsis } from "../design/ellipsis";
import {
  formatBytes,
  formatCount,
  formatDuration,
  formatQuantity,
  formatSpeed,
  sentence,
} from "../design/format";
import { Icon, type IconName } from "../design/icons";
import { Progress } from "../design/progress";
import type { UploadItem, UploadSnapshot, UploadState } from "./upload_queue";
import { uploads } from "./upload_start";
import { useUploads } from "./use_uploads";
import "./uploads.css";

const SHOWN = 200;
const ORDER: UploadState[] = ["failed", "sending", "waiting", "cancelled", "existing", "added"];
const STATES: Record<UploadState, { icon: IconName; text: string }> = {
  waiting: { icon: "clock", text: "Waiting" },
  sending: { icon: "upload", text: "Sending" },
  added: { icon: "check", text: "Added" },
  existing: { icon: "check", text: "Already there" },
  failed: { icon: "warning", text: "Failed" },
  cancelled: { icon: "stop", text: "Cancelled" },
};

/** What is being uploaded, in the corner of every dataset page; it stays until it is closed. */
export function UploadPanel() {
  const snapshot = useUploads();
  const [folded, setFolded] = useState(false);
  if (snapshot.items.length === 0) return null;
  const { counts, active } = snapshot;
  const again = counts.failed + counts.cancelled > 0 && !active;
  return (
    <section className="upload-panel" aria-label="Uploads">
      <header className="upload-panel__header">
        <h2 className="numeric" aria-live="polite">
          {title(snapshot)}
        </h2>
        <div className="upload-panel__actions">
          {active ? (
            <Button small onClick={() => uploads.cancel()}>
              Cancel
            </Button>
          ) : null}
          {again ? (
            <Button small icon="retry" onClick={() => uploads.retry()}>
              Retry
            </Button>
          ) : null}
          <IconButton
            small
            side="up"
            icon={folded ? "up" : "down"}
            label={folded ? "Show files" : "Hide files"}
            aria-expanded={!folded}
            onClick={() => setFolded(!folded)}
          />
          {active ? null : (
            <IconButton small side="end" icon="cross" label="Close" onClick={() => uploads.clear()} />
          )}
        </div>
      </header>
      <div className="upload-panel__overall">
        <Progress
          label="Upload"
          value={snapshot.sent}
          total={Math.max(1, snapshot.bytes)}
          tone={active ? "accent" : counts.failed > 0 ? "danger" : "success"}
        />
        <p className="muted numeric">{facts(snapshot)}</p>
      </div>
      {folded ? null : <FileList items={snapshot.items} />}
    </section>
  );
}

function FileList({ items }: { items: UploadSnapshot["items"] }) {
  const sorted = ORDER.flatMap((state) => items.filter((item) => item.state === state));
  return (
    <ul className="upload-panel__files">
      {sorted.slice(0, SHOWN).map((item) => (
        <FileRow key={item.id} item={item} />
      ))}
      {sorted.length > SHOWN ? (
        <li className="upload-panel__more muted">and {formatCount(sorted.length - SHOWN)} more</li>
      ) : null}
    </ul>
  );
}

function FileRow({ item }: { item: Readonly<UploadItem> }) {
  const { icon, text } = STATES[item.state];
  const percent = item.size > 0 ? Math.floor((100 * item.sent) / item.size) : 0;
  // All of it is sent, but the server still looks at it.
  const sending = percent >= 100 ? "Checking" : `${percent} %`;
  return (
    <li className={`upload-file upload-file--${item.state}`}>
      <Icon name={icon} size={14} />
      <Ellipsis text={item.path} end={14} />
      <span className="upload-file__state numeric">{item.state === "sending" ? sending : text}</span>
      {item.error ? (
        <p className="upload-file__error">
          {sentence(item.error.message)} {item.error.hint ? sentence(item.error.hint) : null}
        </p>
      ) : null}
    </li>
  );
}

function title({ active, counts, items }: UploadSnapshot): string {
  const over = counts.added + counts.existing + counts.failed + counts.cancelled;
  if (active) return `Uploading ${formatCount(over)} of ${formatQuantity(items.length, "file")}`;
  const parts = [`${formatQuantity(counts.added, "file")} uploaded`];
  if (counts.existing > 0) parts.push(`${formatCount(counts.existing)} already there`);
  if (counts.failed > 0) parts.push(`${formatCount(counts.failed)} failed`);
  if (counts.cancelled > 0) parts.push(`${formatCount(counts.cancelled)} cancelled`);
  return parts.join(", ");
}

function facts({ active, bytes, sent, bytesPerSecond }: UploadSnapshot): string {
  if (!active) return formatBytes(bytes);
  const parts = [`${formatBytes(Math.round(sent))} of ${formatBytes(bytes)}`];
  if (bytesPerSecond > 0) {
    parts.push(formatSpeed(bytesPerSecond));
    if (sent < bytes) parts.push(`${formatDuration((bytes - sent) / bytesPerSecond)} left`);
  }
  return parts.join(" · ");
}
