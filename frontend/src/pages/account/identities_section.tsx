import { useQuery } from "@tanstack/react-query";
import { useSearchParams } from "react-router";
import { unlinkIdentity } from "../../api/account_endpoints";
import { accountKeys, providersQuery } from "../../api/account_queries";
import type { Account } from "../../api/account_types";
import { Button, buttonClass } from "../../design/button";
import { formatDate } from "../../design/format";
import { providerProblem } from "../sign_in/provider_problem";
import { useFollowed } from "../use_followed";

/** Other ways in: providers that know who one is. Linking is undone by unlinking, and the other way round. */
export function IdentitiesSection({ account }: { account: Account }) {
  const providers = useQuery(providersQuery);
  const [parameters] = useSearchParams();
  const follow = useFollowed(accountKeys.account);
  const problem = providerProblem(parameters.get("problem"));
  const { identities } = account;
  const offered = identities.length === 0 ? (providers.data ?? []) : [];
  if (offered.length === 0 && identities.length === 0) return null;
  return (
    <section className="section card" aria-labelledby="identities-title">
      <h2 id="identities-title">Other ways in</h2>
      {offered.map(({ name, start }) => (
        <div key={start} className="account-page__fact">
          <span>{name}</span>
          <a className={buttonClass("default", true)} href={`${start}?next=/account&link=true`}>
            Link it to this account
          </a>
        </div>
      ))}
      {identities.map(({ id, issuer, created_at }) => (
        <div key={id} className="account-page__fact">
          <span title={issuer}>
            {new URL(issuer).host} <span className="muted">linked {formatDate(created_at)}</span>
          </span>
          {account.has_password || identities.length > 1 ? (
            <Button small onClick={() => void follow(() => unlinkIdentity(id))}>
              Unlink
            </Button>
          ) : (
            <span className="muted">Your only way in, until you choose a password.</span>
          )}
        </div>
      ))}
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
    </section>
  );
}
