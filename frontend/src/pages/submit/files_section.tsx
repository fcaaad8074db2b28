import { Link } from "react-router";
import type { Split } from "../../api/board_types";
import type { FileToSend } from "../../api/upload";
import { IconButton } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatBytes, formatCount, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { FileButtons } from "../../uploads/file_buttons";
import type { Picked } from "../../uploads/picked_files";
import { bytesOf } from "./submit_form_data";

const ACCEPTED = ".zip,.tar.gz,.tgz,.gz,.json,.npz,.npy";
const NAMES_SHOWN = 4;

interface FilesSectionProps {
  split: Split;
  files: readonly FileToSend[];
  onPicked: (picked: Picked) => void;
  onClear: () => void;
}

/** Where files are put, and what has been put there. */
export function FilesSection({ split, files, onPicked, onClear }: FilesSectionProps) {
  if (files.length > 0) {
    return (
      <section className="submit-files card" aria-label="Chosen files">
        <Icon name="folder" />
        <div className="submit-files__names">
          <strong className="numeric">
            {formatQuantity(files.length, "file")}, {formatBytes(bytesOf(files))}
          </strong>
          <ul className="muted">
            {files.slice(0, NAMES_SHOWN).map(({ path }) => (
              <li key={path}>
                <Ellipsis text={path} end={16} />
              </li>
            ))}
            {files.length > NAMES_SHOWN ? <li>and {formatCount(files.length - NAMES_SHOWN)} more</li> : null}
          </ul>
        </div>
        <IconButton icon="cross" label="Choose other files" side="end" onClick={onClear} />
      </section>
    );
  }
  return (
    <section className="submit-drop" aria-label="Files">
      <Icon name="upload" size={26} />
      <h2>Drop the results here</h2>
      <p className="muted">
        One zip or tar.gz, one file for all images, or one npz, JSON or npy file for each of the{" "}
        {formatQuantity(split.version.images, "image")}, named like the image.
      </p>
      <div className="submit-drop__actions">
        <FileButtons tone="primary" accept={ACCEPTED} onPicked={onPicked} />
      </div>
      <details className="submit-drop__formats">
        <summary>Formats</summary>
        <dl>
          <dt>npz per image</dt>
          <dd>
            <code>points</code> float32 (M, 2), x right, y down; <code>offsets</code> int64 (S + 1);{" "}
            <code>scores</code> float32 (S) if there are any
          </dd>
          <dt>JSON per image</dt>
          <dd>
            <code>{'{"segments": [{"points": [[x, y], …], "score": 0.9}]}'}</code>
          </dd>
          <dt>One JSON for all</dt>
          <dd>
            <code>{'{"images": {"NAME": {"segments": […]}}}'}</code>
          </dd>
          <dt>One npz for all</dt>
          <dd>
            <code>names</code>, <code>image_offsets</code>, <code>offsets</code>, <code>points</code>,{" "}
            <code>scores</code>
          </dd>
          <dt>npy per image</dt>
          <dd>The paper's object arrays; they are read without being executed.</dd>
        </dl>
        <p>
          <Link to="/docs/scoring#formats">All of it, with examples</Link>
        </p>
        <p className="muted">
          Without a browser:{" "}
          <code>
            clearlines submit --server {window.location.origin} --split {split.slug} --method NAME DIR
          </code>
        </p>
      </details>
    </section>
  );
}
