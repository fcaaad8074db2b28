import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { signIn, signOut } from "../api/board_endpoints";
import { meQuery } from "../api/board_queries";
import type { Me } from "../api/board_types";
import { chosenPerson } from "../api/person";
import { asProblem } from "../api/problem";
import { Button } from "./button";
import { sentence } from "./format";
import { PersonForm } from "./person_form";
import { Popover } from "./popover";
import "./sign_in.css";

const MAY: Record<Me["role"], string> = {
  owner: "May do everything.",
  maintainer: "May label, freeze splits and see hidden ones.",
  annotator: "May label.",
  submitter: "May submit results.",
  reader: "May look at what is public.",
};

/** Who is signed in, and the place to sign in with a token. */
export function SignIn() {
  const me = useQuery(meQuery);
  if (!me.data) return null;
  const { name, role, anonymous } = me.data;
  const invited = anonymous && role === "reader";
  const local = anonymous && role === "owner";
  const chosen = local ? chosenPerson() : null;
  const label = anonymous ? (invited ? "Sign in" : (chosen ?? `Not signed in, ${role}`)) : `${name}, ${role}`;
  return (
    <Popover label={label} icon="person" iconOnly={!invited && chosen === null} tone="quiet">
      {(close) => (
        <div className="sign-in">
          <p className="sign-in__who">
            <strong>{anonymous ? (chosen ?? "Not signed in") : name}</strong>
            <span className="badge">{role}</span>
          </p>
          {local ? <PersonForm close={close} /> : null}
          <p className="muted">
            {local ? "On this computer everything is allowed without a token." : MAY[role]}
          </p>
          {anonymous ? <TokenForm close={close} /> : <SignOut close={close} />}
        </div>
      )}
    </Popover>
  );
}

function TokenForm({ close }: { close: () => void }) {
  const client = useQueryClient();
  const [token, setToken] = useState("");
  const [problem, setProblem] = useState<string | null>(null);
  const [busy, setBusy] = useState(false);
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    try {
      await signIn(token.trim());
      // Somebody else sees other things: nothing that was fetched before may stay.
      await client.resetQueries();
      close();
    } catch (error) {
      const { message, hint } = asProblem(error);
      setProblem([message, hint].flatMap((text) => (text ? [sentence(text)] : [])).join(" "));
      setBusy(false);
    }
  };
  return (
    <form className="sign-in__form" onSubmit={submit}>
      <label className="field">
        <span className="field__label">Token</span>
        <input
          className="input mono"
          type="password"
          autoComplete="off"
          spellCheck={false}
          placeholder="cl_…"
          aria-invalid={problem !== null}
          value={token}
          onChange={(event) => setToken(event.target.value)}
        />
        <span className="field__hint">
          Made by whoever runs this server: <code>clearlines token create NAME --role submitter</code>
        </span>
      </label>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
      <Button type="submit" tone="primary" busy={busy} disabled={token.trim() === ""}>
        Sign in
      </Button>
    </form>
  );
}

function SignOut({ close }: { close: () => void }) {
  const client = useQueryClient();
  const [problem, setProblem] = useState<string | null>(null);
  const leave = async () => {
    try {
      await signOut();
      await client.resetQueries();
      close();
    } catch (error) {
      setProblem(sentence(asProblem(error).message));
    }
  };
  return (
    <>
      <Button onClick={leave}>Sign out</Button>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
    </>
  );
}
