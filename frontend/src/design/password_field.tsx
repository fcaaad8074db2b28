import { useId, useState } from "react";
import { IconButton } from "./button";
import "./password_field.css";

interface PasswordFieldProps {
  label: string;
  value: string;
  onChange: (password: string) => void;
  /** Tells password managers whether it is to be filled in or made up. */
  kind: "current" | "new";
  hint?: string;
}

/** A password that can be looked at while it is typed, so that nobody need type it twice. */
export function PasswordField({ label, value, onChange, kind, hint }: PasswordFieldProps) {
  const [shown, setShown] = useState(false);
  const field = useId();
  const described = useId();
  return (
    <div className="field">
      <label className="field__label" htmlFor={field}>
        {label}
      </label>
      <span className="password-field">
        <input
          id={field}
          className="input"
          type={shown ? "text" : "password"}
          autoComplete={`${kind}-password`}
          spellCheck={false}
          aria-describedby={hint ? described : undefined}
          value={value}
          onChange={(event) => onChange(event.target.value)}
        />
        <IconButton
          icon="eye"
          label={shown ? "Hide what is typed" : "Show what is typed"}
          aria-pressed={shown}
          side="end"
          onClick={() => setShown(!shown)}
        />
      </span>
      {hint ? (
        <span id={described} className="field__hint">
          {hint}
        </span>
      ) : null}
    </div>
  );
}
