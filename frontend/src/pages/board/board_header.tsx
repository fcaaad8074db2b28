import { Link } from "react-router";
import { boardCsvUrl, boardUrl, splitImagesUrl, truthUrl } from "../../api/board_endpoints";
import type { Split } from "../../api/board_types";
import { buttonClass } from "../../design/button";
import { formatCount, formatDay, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { Popover } from "../../design/popover";
import { DeadlineBadge, VisibilityBadge } from "../split_badges";
import { ProtocolExplained } from "./protocol_explained";

interface BoardHeaderProps {
  split: Split;
  /** Null for the newest. */
  version: number | null;
  onVersion: (number: number) => void;
}

export function BoardHeader({ split, version, onVersion }: BoardHeaderProps) {
  const shown = split.versions.find(({ number }) => number === version) ?? split.version;
  return (
    <header className="board-page__header">
      <div className="board-page__title">
        <h1>{split.name}</h1>
        <p className="board-page__facts muted numeric">
          <VisibilityBadge visibility={split.visibility} />
          <DeadlineBadge split={split} />
          <span>{formatQuantity(shown.images, "image")}</span>
          {shown.labels === null ? null : <span>{formatQuantity(shown.labels, "label")}</span>}
          {shown.ambiguous ? <span>{formatCount(shown.ambiguous)} ambiguous, not scored</span> : null}
          {split.min_length > 0 ? <span>from {split.min_length} px</span> : null}
          {split.dataset ? (
            <Link to={`/datasets/${split.dataset.slug}/card`}>About {split.dataset.name}</Link>
          ) : null}
        </p>
        {split.description ? <p>{split.description}</p> : null}
      </div>
      <div className="board-page__actions">
        {split.versions.length > 1 ? (
          <label className="board-version">
            <span className="muted">Version</span>
            <select
              className="input"
              value={shown.number}
              onChange={(event) => onVersion(Number(event.target.value))}
            >
              {[...split.versions]
                .sort((a, b) => b.number - a.number)
                .map(({ number, created_at }) => (
                  <option key={number} value={number}>
                    {number}, {formatDay(created_at)}
                  </option>
                ))}
            </select>
          </label>
        ) : null}
        <Popover label={split.protocol} icon="info">
          {() => <ProtocolExplained split={split} shown={shown} />}
        </Popover>
        <Popover label="Download" icon="download">
          {() => (
            <>
              <Saved href={boardCsvUrl(split.slug, version)} text="Board as CSV" download />
              <Saved href={boardUrl(split.slug, version)} text="Board as JSON" />
              <Saved href={splitImagesUrl(split.slug)} text="Images to run on, as JSON" />
              {split.can.see_details ? (
                <>
                  <Saved href={truthUrl(split.slug, version, "npz")} text="Ground truth as npz" download />
                  <Saved href={truthUrl(split.slug, version, "json")} text="Ground truth as JSON" download />
                </>
              ) : null}
            </>
          )}
        </Popover>
        <SubmitLink split={split} />
      </div>
    </header>
  );
}

function Saved({ href, text, download }: { href: string; text: string; download?: boolean }) {
  return (
    <a className="menu-item board-menu-link" href={href} download={download ? "" : undefined}>
      <Icon name={download ? "download" : "external"} /> {text}
    </a>
  );
}

function SubmitLink({ split }: { split: Split }) {
  if (split.closed) return null;
  return (
    <Link to={`/splits/${split.slug}/submit`} className={buttonClass("primary")}>
      <Icon name="upload" /> Submit results
    </Link>
  );
}
