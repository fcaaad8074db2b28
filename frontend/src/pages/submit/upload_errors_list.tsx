import { useState } from "react";
import type { UploadError } from "../../api/board_types";
import { Button } from "../../design/button";
import { CopyButton } from "../../design/copy_button";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { adviceText, errorsText, type FileErrors, groupByFile, placeText } from "./upload_errors";
import "./validation.css";

const FILES_SHOWN = 12;
const ERRORS_SHOWN = 5;

/** Everything that is wrong with an upload, at once. */
export function UploadErrors({ title, errors }: { title: string; errors: readonly UploadError[] }) {
  const [all, setAll] = useState(false);
  const groups = groupByFile(errors);
  const shown = all ? groups : groups.slice(0, FILES_SHOWN);
  const cut = groups.length > FILES_SHOWN || groups.some((group) => group.errors.length > ERRORS_SHOWN);
  return (
    <section className="upload-errors" role="alert" aria-label="What is wrong">
      <header className="section__header">
        <h2>
          {title}: <span className="numeric">{formatQuantity(errors.length, "error")}</span>
          {groups.length > 1 ? (
            <span className="numeric"> in {formatQuantity(groups.length, "file")}</span>
          ) : null}
        </h2>
        <CopyButton text={errorsText(errors)} label="Copy all errors" />
      </header>
      <ol className="upload-errors__files">
        {shown.map((group) => (
          <FileGroup key={group.file ?? ""} group={group} limit={all ? group.errors.length : ERRORS_SHOWN} />
        ))}
      </ol>
      {cut && !all ? (
        <Button small onClick={() => setAll(true)}>
          Show all {formatCount(errors.length)}
        </Button>
      ) : null}
      <p className="muted">
        Nothing was stored, and it counts for no limit. Mend the files and choose them again.
      </p>
    </section>
  );
}

function FileGroup({ group, limit }: { group: FileErrors; limit: number }) {
  const rest = group.errors.length - limit;
  return (
    <li>
      <h3 className="mono">{group.file ?? "The upload"}</h3>
      <ul>
        {group.errors.slice(0, limit).map((error) => {
          const place = placeText(error);
          const advice = adviceText(error);
          return (
            <li key={`${place} ${error.message}`}>
              {place ? <span className="upload-errors__place numeric">{place}</span> : null}
              <span>
                {sentence(error.message)}
                {advice ? <span className="muted"> {advice}</span> : null}
              </span>
            </li>
          );
        })}
        {rest > 0 ? <li className="muted numeric">and {formatCount(rest)} more in this file</li> : null}
      </ul>
    </li>
  );
}
