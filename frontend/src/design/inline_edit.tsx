import { type FormEvent, useEffect, useRef, useState } from "react";
import { Button } from "./button";
import { sentence } from "./format";

interface InlineEditProps {
  /** Accessible name of the field. */
  label: string;
  value: string;
  /** Rejects with the reason where the text isn't taken; the field then stays open and shows it. */
  save: (text: string) => Promise<unknown>;
  close: () => void;
  submitLabel?: string;
  placeholder?: string;
  maxLength?: number;
}

/** A text field in the place of what it changes. Enter saves, Escape closes, an unchanged text just closes. */
export function InlineEdit(props: InlineEditProps) {
  const { label, value, save, close, submitLabel = "Save", placeholder, maxLength = 200 } = props;
  const [text, setText] = useState(value);
  const [problem, setProblem] = useState<string | null>(null);
  const [busy, setBusy] = useState(false);
  const input = useRef<HTMLInputElement>(null);

  useEffect(() => {
    input.current?.focus();
    input.current?.select();
  }, []);

  const submit = async (event: FormEvent) => {
    event.preventDefault();
    const wanted = text.trim();
    if (wanted === "" || wanted === value) return close();
    setBusy(true);
    try {
      await save(wanted);
      close();
    } catch (error) {
      setProblem(sentence(error instanceof Error ? error.message : String(error)));
      setBusy(false);
      input.current?.focus();
    }
  };

  return (
    <form
      className="inline-edit"
      onSubmit={submit}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === "Escape") close();
      }}
    >
      <div className="inline-edit__row">
        <input
          ref={input}
          className="input"
          aria-label={label}
          aria-invalid={problem !== null}
          placeholder={placeholder}
          maxLength={maxLength}
          value={text}
          onChange={(event) => setText(event.target.value)}
        />
        <Button tone="primary" type="submit" busy={busy}>
          {submitLabel}
        </Button>
        <Button tone="quiet" onClick={close}>
          Cancel
        </Button>
      </div>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
    </form>
  );
}
