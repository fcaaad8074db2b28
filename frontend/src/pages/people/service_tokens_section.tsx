import { revokeToken } from "../../api/account_endpoints";
import { accountKeys } from "../../api/account_queries";
import type { ServiceToken } from "../../api/account_types";
import { TokensTable } from "../tokens_table";
import { useFollowed } from "../use_followed";

/** Tokens that are good now: of services, which the command line makes, and of people. */
export function ServiceTokensSection({ tokens }: { tokens: readonly ServiceToken[] }) {
  const follow = useFollowed(accountKeys.serviceTokens);
  return (
    <section className="section card" aria-labelledby="service-tokens-title">
      <header className="section__header">
        <h2 id="service-tokens-title">Tokens</h2>
        <span className="muted">
          Services get one where the server runs: <code>clearlines token create NAME --role ROLE</code>
        </span>
      </header>
      {tokens.length === 0 ? (
        <p className="muted">None are good now.</p>
      ) : (
        <TokensTable label="Tokens" tokens={tokens} revoke={(id) => void follow(() => revokeToken(id))} />
      )}
    </section>
  );
}
