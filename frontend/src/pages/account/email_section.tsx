import { useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { changeAccount } from "../../api/account_endpoints";
import { accountKeys } from "../../api/account_queries";
import type { Account } from "../../api/account_types";
import { Button } from "../../design/button";
import { InlineEdit } from "../../design/inline_edit";

/** Where whoever runs the server can reach one; nobody else sees it. */
export function EmailSection({ account }: { account: Account }) {
  const client = useQueryClient();
  const [editing, setEditing] = useState(false);
  const save = async (email: string) => {
    client.setQueryData(accountKeys.account, await changeAccount({ email }));
  };
  return (
    <section className="section card" aria-labelledby="email-title">
      <header className="section__header">
        <h2 id="email-title">E-mail</h2>
        <span className="muted">Only administrators see it.</span>
      </header>
      {editing ? (
        <InlineEdit
          label="E-mail address"
          value={account.email ?? ""}
          placeholder="name@example.org"
          maxLength={320}
          save={save}
          close={() => setEditing(false)}
        />
      ) : (
        <div className="account-page__fact">
          <span>{account.email ?? <span className="muted">None given</span>}</span>
          <Button small icon="pencil" onClick={() => setEditing(true)}>
            {account.email ? "Change" : "Give one"}
          </Button>
        </div>
      )}
    </section>
  );
}
