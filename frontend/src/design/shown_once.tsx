import { Button } from "./button";
import { CopyButton } from "./copy_button";
import "./shown_once.css";

interface ShownOnceProps {
  /** What it is: "Invitation link". */
  label: string;
  text: string;
  /** What to do with it, and that it can't be had again. */
  hint: string;
  close: () => void;
}

/** A secret at the one moment when it is known. */
export function ShownOnce({ label, text, hint, close }: ShownOnceProps) {
  return (
    <div className="shown-once" role="status">
      <span className="field__label">{label}</span>
      <div className="shown-once__row">
        <input
          className="input mono"
          readOnly
          aria-label={label}
          value={text}
          onFocus={(event) => event.target.select()}
        />
        <CopyButton text={text} label={`Copy: ${label}`} />
        <Button onClick={close}>Done</Button>
      </div>
      <span className="field__hint">{hint}</span>
    </div>
  );
}
