import { type FormEvent, useId, useState } from "react";
import type { Split } from "../../api/board_types";
import type { Problem } from "../../api/types";
import type { FileToSend } from "../../api/upload";
import { Button } from "../../design/button";
import { formatBytes, sentence } from "../../design/format";
import { Progress } from "../../design/progress";
import { Segmented } from "../../design/segmented";
import { FileDrop } from "../../uploads/file_drop";
import type { Picked } from "../../uploads/picked_files";
import { Note } from "../note";
import { UrlField } from "../url_field";
import { FilesSection } from "./files_section";
import { bytesOf, NO_FIELDS, type SubmissionFields } from "./submit_form_data";
import { UploadErrors } from "./upload_errors_list";
import { useOwnMethods } from "./use_own_submissions";
import { type Attempt, useSubmit } from "./use_submit";
import { ValidationReport } from "./validation_report";

/** Up to here files are checked as soon as they are chosen: nobody waits for that. */
const CHECKED_AT_ONCE = 25e6;

export function SubmitForm({ split, onSent }: { split: Split; onSent: (id: number) => void }) {
  const { attempt, check, send, reset } = useSubmit(split.slug);
  const [files, setFiles] = useState<FileToSend[]>([]);
  const [fields, setFields] = useState(NO_FIELDS);
  const busy = attempt.state === "checking" || attempt.state === "sending";

  const pick = (picked: Picked) => {
    if (picked.files.length === 0) return;
    setFiles(picked.files);
    reset();
    if (bytesOf(picked.files) <= CHECKED_AT_ONCE) void check(picked.files);
  };
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    const submission = await send(files, fields);
    if (submission) onSent(submission.id);
  };

  return (
    <form className="submit-form" onSubmit={submit}>
      <FilesSection
        split={split}
        files={files}
        onPicked={pick}
        onClear={() => {
          setFiles([]);
          reset();
        }}
      />
      <AttemptState attempt={attempt} />
      <Fields fields={fields} split={split} onChange={(changes) => setFields({ ...fields, ...changes })} />
      <div className="submit-form__actions">
        <Button
          type="submit"
          tone="primary"
          icon="upload"
          busy={attempt.state === "sending"}
          disabled={busy || files.length === 0 || fields.method.trim() === "" || attempt.state === "refused"}
        >
          Submit{files.length > 0 ? ` ${formatBytes(bytesOf(files))}` : ""}
        </Button>
        <Button
          icon="check"
          disabled={busy || files.length === 0}
          busy={attempt.state === "checking"}
          onClick={() => check(files)}
        >
          Check only
        </Button>
        <span className="muted">
          Checking is free, as often as you like; so is a submission that isn't valid.
        </span>
      </div>
      <FileDrop
        label={`Drop to submit to ${split.name}`}
        hint="One archive, or one file per image"
        onPicked={pick}
      />
    </form>
  );
}

function AttemptState({ attempt }: { attempt: Attempt }) {
  if (attempt.state === "idle") return null;
  if (attempt.state === "valid") return <ValidationReport validation={attempt.validation} />;
  if (attempt.state === "refused") return <UploadErrors title={attempt.title} errors={attempt.errors} />;
  if (attempt.state === "stopped") return <Stopped problem={attempt.problem} />;
  const { sent, total, state } = attempt;
  const uploaded = total > 0 && sent >= total;
  return (
    <div className="submit-form__progress card" role="status">
      <span>
        {uploaded
          ? "Uploaded, being checked"
          : state === "checking"
            ? "Uploading for the check"
            : "Uploading"}
        {total > 0 ? (
          <span className="muted numeric">
            {" "}
            {formatBytes(sent)} of {formatBytes(total)}
          </span>
        ) : null}
      </span>
      <Progress label="Upload" value={uploaded ? 0 : sent} total={uploaded ? 0 : total} />
    </div>
  );
}

function Stopped({ problem }: { problem: Problem }) {
  const { title, message, expected, hint } = problem;
  const advice = [expected ? `expected: ${expected}` : null, hint].flatMap((text) =>
    text ? [sentence(text)] : [],
  );
  return (
    <Note tone="danger">
      <strong>{title}.</strong> {sentence(message)} {advice.join(" ")}
    </Note>
  );
}

interface FieldsProps {
  split: Split;
  fields: SubmissionFields;
  onChange: (changes: Partial<SubmissionFields>) => void;
}

function Fields({ split, fields, onChange }: FieldsProps) {
  const own = useOwnMethods(split.slug);
  const list = useId();
  const known = own.some((name) => name === fields.method.trim());
  return (
    <section className="section card submit-fields" aria-label="About these results">
      <label className="field">
        <span className="field__label">Method</span>
        <input
          className="input"
          required
          maxLength={200}
          list={list}
          autoComplete="off"
          placeholder="Name of the detector"
          value={fields.method}
          onChange={(event) => onChange({ method: event.target.value })}
        />
        <datalist id={list}>
          {own.map((name) => (
            <option key={name} value={name} />
          ))}
        </datalist>
        <span className="field__hint">
          {known
            ? "A further version of your method; the board shows its best one."
            : "One row on the board per method; submit its next version under the same name."}
        </span>
      </label>
      <label className="field">
        <span className="field__label">Version, in your words</span>
        <input
          className="input"
          maxLength={100}
          placeholder="v2, threshold 0.4"
          value={fields.label}
          onChange={(event) => onChange({ label: event.target.value })}
        />
      </label>
      <label className="field submit-fields__wide">
        <span className="field__label">Description</span>
        <textarea
          className="input submit-fields__text"
          rows={2}
          maxLength={4000}
          placeholder="What it does, what it was trained on"
          value={fields.description}
          onChange={(event) => onChange({ description: event.target.value })}
        />
      </label>
      <UrlField label="Code" value={fields.code_url} onChange={(code_url) => onChange({ code_url })} />
      <UrlField label="Paper" value={fields.paper_url} onChange={(paper_url) => onChange({ paper_url })} />
      <div className="field">
        <span className="field__label">Who sees it</span>
        <Segmented
          label="Who sees it"
          name="visibility"
          value={fields.visibility}
          onChange={(visibility) => onChange({ visibility })}
          choices={[
            { value: "public", label: "Everyone" },
            { value: "private", label: "Only me", title: "You and the maintainers; it isn't on the board" },
          ]}
        />
      </div>
      <UrlField
        label="Call when scored (webhook)"
        value={fields.webhook_url}
        onChange={(webhook_url) => onChange({ webhook_url })}
      />
      <label className="checkbox submit-fields__wide">
        <input
          type="checkbox"
          checked={fields.anonymous}
          onChange={(event) => onChange({ anonymous: event.target.checked })}
        />
        <span>
          Anonymous for now <span className="muted">(your name is shown once you reveal it)</span>
        </span>
      </label>
    </section>
  );
}
