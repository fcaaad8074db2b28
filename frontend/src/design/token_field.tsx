import { useState } from "react";
import { EntranceForm } from "./entrance_form";
import { useSigningIn } from "./use_signing_in";

interface TokenFieldProps {
  signIn: (token: string) => Promise<unknown>;
  close?: () => void;
}

/** For those who were given a token in place of an account. */
export function TokenField({ signIn, close }: TokenFieldProps) {
  const [token, setToken] = useState("");
  const enter = useSigningIn();
  const submit = async () => {
    await enter(() => signIn(token.trim()));
    close?.();
  };
  return (
    <EntranceForm submitLabel="Sign in" ready={token.trim() !== ""} submit={submit}>
      <label className="field">
        <span className="field__label">Token</span>
        <input
          className="input mono"
          type="password"
          autoComplete="off"
          spellCheck={false}
          placeholder="cl_…"
          value={token}
          onChange={(event) => setToken(event.target.value)}
        />
        <span className="field__hint">
          Made by whoever runs this server: <code>clearlines token create NAME --role submitter</code>
        </span>
      </label>
    </EntranceForm>
  );
}
