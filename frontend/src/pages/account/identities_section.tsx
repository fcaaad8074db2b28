import { useQuery } from "@tanstack/react-query";
import { useSearchParams } from "react-router";
import { providersQuery } from "../../api/account_queries";
import type { Account } from "../../api/account_types";
import { Badge } from "../../design/badge";
import { buttonClass } from "../../design/button";
import { providerProblem } from "../sign_in/provider_problem";

/** Other ways in: providers that know who one is. */
export function IdentitiesSection({ account }: { account: Account }) {
  const providers = useQuery(providersQuery);
  const [parameters] = useSearchParams();
  const problem = providerProblem(parameters.get("problem"));
  if (!providers.data || providers.data.length === 0) return null;
  return (
    <section className="section card" aria-labelledby="identities-title">
      <h2 id="identities-title">Other ways in</h2>
      {providers.data.map(({ name, start }) => (
        <div key={start} className="account-page__fact">
          <span>{name}</span>
          {account.has_identity ? (
            <Badge tone="success" icon="check">
              Linked
            </Badge>
          ) : (
            <a className={buttonClass("default", true)} href={`${start}?next=/account&link=true`}>
              Link it to this account
            </a>
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
