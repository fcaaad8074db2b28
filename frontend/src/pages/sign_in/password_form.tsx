import { useState } from "react";
import { signInWithPassword } from "../../api/account_endpoints";
import { EntranceForm } from "../../design/entrance_form";
import { PasswordField } from "../../design/password_field";

interface EnterProps {
  /** Does what signs in, and has the page follow. */
  enter: (act: () => Promise<unknown>) => Promise<void>;
}

export function PasswordForm({ enter }: EnterProps) {
  const [name, setName] = useState("");
  const [password, setPassword] = useState("");
  return (
    <EntranceForm
      submitLabel="Sign in"
      ready={name.trim() !== "" && password !== ""}
      submit={() => enter(() => signInWithPassword(name.trim(), password))}
    >
      <label className="field">
        <span className="field__label">Name</span>
        <input
          className="input"
          autoComplete="username"
          autoCapitalize="none"
          spellCheck={false}
          // biome-ignore lint/a11y/noAutofocus: the page is there for nothing else
          autoFocus
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
      </label>
      <PasswordField label="Password" kind="current" value={password} onChange={setPassword} />
    </EntranceForm>
  );
}
