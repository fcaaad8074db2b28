import { type FormEvent, type ReactNode, useState } from "react";
import { asProblem } from "../api/problem";
import { Button } from "../design/button";
import { sentence } from "../design/format";

interface SavedFormProps {
  className: string;
  /** Rejects where it can't be saved; the reason is shown below the fields. */
  save: () => Promise<unknown>;
  close: () => void;
  children: ReactNode;
}

/** Fields that are saved together; Escape leaves them as they were. */
export function SavedForm({ className, save, close, children }: SavedFormProps) {
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    try {
      await save();
      close();
    } catch (error) {
      setProblem(sentence(asProblem(error).message));
      setBusy(false);
    }
  };
  return (
    <form
      className={`section card ${className}`}
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key === "Escape") close();
      }}
    >
      {children}
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
      <div className="board-page__actions">
        <Button type="submit" tone="primary" busy={busy}>
          Save
        </Button>
        <Button tone="quiet" onClick={close}>
          Cancel
        </Button>
      </div>
    </form>
  );
}

/** What was typed; null where nothing was. */
export function given(text: string): string | null {
  const trimmed = text.trim();
  return trimmed === "" ? null : trimmed;
}
