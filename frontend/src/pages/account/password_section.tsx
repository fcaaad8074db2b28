import { useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { changePassword } from "../../api/account_endpoints";
import { accountKeys } from "../../api/account_queries";
import type { Account } from "../../api/account_types";
import { Button } from "../../design/button";
import { FormProblem } from "../../design/form_problem";
import { PasswordField } from "../../design/password_field";
import { toast } from "../../design/toast";
import { useSentForm } from "../../design/use_sent_form";

export function PasswordSection({ account }: { account: Account }) {
  const client = useQueryClient();
  const [current, setCurrent] = useState("");
  const [wanted, setWanted] = useState("");
  const { onSubmit, busy, problem } = useSentForm(async () => {
    await changePassword(account.has_password ? current : null, wanted);
    setCurrent("");
    setWanted("");
    toast({ tone: "success", message: "The password is changed; other browsers are signed out." });
    await client.invalidateQueries({ queryKey: accountKeys.account });
  });
  return (
    <section className="section card" aria-labelledby="password-title">
      <h2 id="password-title">Password</h2>
      <form className="account-page__form" onSubmit={onSubmit}>
        <input type="text" autoComplete="username" value={account.name} readOnly hidden />
        {account.has_password ? (
          <PasswordField label="Current password" kind="current" value={current} onChange={setCurrent} />
        ) : (
          <p className="muted">You sign in through a provider; a password is a second way in.</p>
        )}
        <PasswordField
          label="New password"
          kind="new"
          hint="At least 10 characters; several words are fine."
          value={wanted}
          onChange={setWanted}
        />
        <FormProblem text={problem} />
        <Button
          type="submit"
          busy={busy}
          disabled={wanted === "" || (account.has_password && current === "")}
        >
          Change the password
        </Button>
      </form>
    </section>
  );
}
