import { type FormEvent, useEffect, useRef, useState } from "react";
import { Button } from "../../../design/button";

const USUAL_REASONS = ["Lines are missing", "Blurred", "No straight lines"] as const;
const LONGEST = 2_000;

interface DiscardFormProps {
  onDiscard: (reason: string) => void;
  onClose: () => void;
}

/** Asks why an image is left out: a reason of one's own, or one press on a usual one. */
export function DiscardForm({ onDiscard, onClose }: DiscardFormProps) {
  const [reason, setReason] = useState("");
  const form = useRef<HTMLFormElement>(null);
  const input = useRef<HTMLInputElement>(null);

  useEffect(() => {
    input.current?.focus({ preventScroll: true });
    form.current?.scrollIntoView({ block: "nearest" });
  }, []);

  function submit(event: FormEvent): void {
    event.preventDefault();
    if (reason.trim() !== "") onDiscard(reason.trim());
  }

  return (
    <form
      ref={form}
      className="discard-form"
      aria-label="Discard this image"
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key !== "Escape") return;
        event.stopPropagation();
        onClose();
      }}
    >
      <label className="field">
        <span className="field__label">Why is this image left out?</span>
        <input
          ref={input}
          className="input"
          value={reason}
          maxLength={LONGEST}
          placeholder="Reason"
          onChange={(event) => setReason(event.target.value)}
        />
      </label>
      <div className="discard-form__reasons">
        {USUAL_REASONS.map((usual) => (
          <Button key={usual} small onClick={() => onDiscard(usual)}>
            {usual}
          </Button>
        ))}
      </div>
      <div className="discard-form__buttons">
        <Button small tone="quiet" onClick={onClose}>
          Cancel
        </Button>
        <Button small tone="primary" type="submit" disabled={reason.trim() === ""}>
          Discard
        </Button>
      </div>
    </form>
  );
}
