import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { endOwnToken, makeOwnToken } from "../../api/account_endpoints";
import { accountKeys, ownTokensQuery } from "../../api/account_queries";
import type { Account } from "../../api/account_types";
import { ShownOnce } from "../../design/shown_once";
import { LoadingState } from "../../design/states";
import { Fetched } from "../fetched";
import { TokensTable } from "../tokens_table";
import { useFollowed } from "../use_followed";
import { NewTokenForm } from "./new_token_form";

/** Tokens with which programs act in one's name. */
export function OwnTokensSection({ account }: { account: Account }) {
  const tokens = useQuery(ownTokensQuery);
  const [made, setMade] = useState<string | null>(null);
  const follow = useFollowed(accountKeys.tokens);
  return (
    <section className="section card" aria-labelledby="tokens-title">
      <header className="section__header">
        <h2 id="tokens-title">Tokens for programs</h2>
        <span className="muted">
          Sent as <code>Authorization: Bearer cl_…</code>; what they do is stored under your name.
        </span>
      </header>
      {made === null ? (
        <NewTokenForm
          most={account.role}
          make={async (label, role, days) => {
            setMade(await makeOwnToken(label, role, days));
            void tokens.refetch();
          }}
        />
      ) : (
        <ShownOnce
          label="Your new token"
          text={made}
          hint="It is shown this once. Keep it where you keep passwords."
          close={() => setMade(null)}
        />
      )}
      <Fetched query={tokens} missing={null} loading={<LoadingState label="Loading" />}>
        {(data) =>
          data.length === 0 ? (
            <p className="muted">None yet.</p>
          ) : (
            <TokensTable
              label="Your tokens"
              tokens={data}
              revoke={(id) => void follow(() => endOwnToken(id))}
            />
          )
        }
      </Fetched>
    </section>
  );
}
