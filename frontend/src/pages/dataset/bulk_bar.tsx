import { type FormEvent, useId, useState } from "react";
import type { ImageChanges } from "../../api/endpoints";
import type { Facets } from "../../api/types";
import { Button, IconButton } from "../../design/button";
import { formatCount } from "../../design/format";
import { Popover } from "../../design/popover";

interface BulkBarProps {
  count: number;
  /** The selection is one of deleted images. */
  deleted: boolean;
  facets: Facets | undefined;
  /** Names of those who have tasks already, or decided on something. */
  people: readonly string[];
  onSet: (changes: ImageChanges) => Promise<boolean>;
  onAssign: (person: string | null) => Promise<boolean>;
  onPrelabel: () => void;
  onDelete: () => void;
  onRestore: () => void;
  onClear: () => void;
}

/** What can be done with the selected images. */
export function BulkBar(props: BulkBarProps) {
  const { count, deleted, facets, people, onSet, onAssign, onPrelabel, onDelete, onRestore, onClear } = props;
  const sources = facets?.sources.flatMap(({ value }) => value ?? []) ?? [];
  const sequences = facets?.sequences.flatMap(({ value }) => value ?? []) ?? [];
  const cameras = facets?.cameras.map(({ name }) => name) ?? [];
  return (
    <section className="bulk-bar" aria-label="Selected images">
      <strong className="numeric" aria-live="polite">
        {formatCount(count)} selected
      </strong>
      {deleted ? (
        <Button small icon="undo" onClick={onRestore}>
          Restore
        </Button>
      ) : (
        <>
          <FieldPopover
            name="Camera"
            known={cameras}
            required
            onSet={(camera) => onSet(camera === null ? {} : { camera })}
          />
          <FieldPopover name="Source" known={sources} onSet={(source) => onSet({ source })} />
          <FieldPopover name="Sequence" known={sequences} onSet={(sequence) => onSet({ sequence })} />
          <FieldPopover name="Task of" known={people} onSet={onAssign} />
          <Button small icon="play" onClick={onPrelabel}>
            Pre-label these
          </Button>
          <Button small icon="trash" tone="danger" onClick={onDelete}>
            Delete
          </Button>
        </>
      )}
      <IconButton small icon="cross" label="Clear the selection" keys={["Esc"]} side="up" onClick={onClear} />
    </section>
  );
}

interface FieldPopoverProps {
  name: string;
  known: readonly string[];
  /** Can't be cleared. */
  required?: boolean;
  onSet: (text: string | null) => Promise<boolean>;
}

function FieldPopover({ name, known, required, onSet }: FieldPopoverProps) {
  return (
    <Popover label={name} small align="start">
      {(close) => (
        <FieldForm name={name} known={known} required={required ?? false} onSet={onSet} close={close} />
      )}
    </Popover>
  );
}

function FieldForm({ name, known, required, onSet, close }: FieldPopoverProps & { close: () => void }) {
  const [text, setText] = useState("");
  const [busy, setBusy] = useState(false);
  const listId = useId();
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    const wanted = text.trim();
    if (wanted === "" && required) return;
    setBusy(true);
    const done = await onSet(wanted === "" ? null : wanted);
    setBusy(false);
    if (done) close();
  };
  return (
    <form className="bulk-bar__field" onSubmit={submit}>
      <label className="field">
        <span className="field__label">{name} of the selected images</span>
        <input
          className="input"
          // biome-ignore lint/a11y/noAutofocus: the field was opened to type into it
          autoFocus
          list={listId}
          maxLength={200}
          placeholder={required ? "A known one or a new one" : "Empty clears it"}
          value={text}
          onChange={(event) => setText(event.target.value)}
        />
      </label>
      <datalist id={listId}>
        {known.map((value) => (
          <option key={value} value={value} />
        ))}
      </datalist>
      <Button type="submit" tone="primary" busy={busy} disabled={required && text.trim() === ""}>
        {text.trim() === "" && !required ? "Clear" : "Set"}
      </Button>
    </form>
  );
}
