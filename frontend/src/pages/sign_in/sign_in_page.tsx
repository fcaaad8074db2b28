import { useQuery } from "@tanstack/react-query";
import { useEffect } from "react";
import { useNavigate, useSearchParams } from "react-router";
import { providersQuery } from "../../api/account_queries";
import { signIn } from "../../api/board_endpoints";
import { meQuery } from "../../api/board_queries";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { TokenField } from "../../design/token_field";
import { useSigningIn } from "../../design/use_signing_in";
import { ownPath } from "./own_path";
import { PasswordForm } from "./password_form";
import { providerProblem } from "./provider_problem";
import "../entrance.css";

/** The way in: a name and a password, a provider, or a token. Leads back to the page that sent here. */
export function SignInPage() {
  const [parameters] = useSearchParams();
  const next = ownPath(parameters.get("next"));
  const problem = providerProblem(parameters.get("problem"));
  const navigate = useNavigate();
  const me = useQuery(meQuery);
  const providers = useQuery(providersQuery);
  const signedIn = me.data ? !me.data.anonymous : false;
  const enter = useSigningIn();
  useEffect(() => {
    if (signedIn) navigate(next, { replace: true });
  }, [signedIn, next, navigate]);
  return (
    <PageFrame crumbs={[{ label: "Sign in" }]}>
      <div className="entrance">
        <section className="entrance__card card" aria-labelledby="sign-in-title">
          <h1 id="sign-in-title">Sign in</h1>
          {problem ? (
            <p className="field__error" role="alert">
              {problem}
            </p>
          ) : null}
          <PasswordForm enter={enter} />
          {providers.data && providers.data.length > 0 ? (
            <>
              <p className="entrance__or muted">or</p>
              {providers.data.map(({ name, start }) => (
                <a key={start} className={buttonClass()} href={`${start}?next=${encodeURIComponent(next)}`}>
                  Sign in with {name}
                </a>
              ))}
            </>
          ) : null}
          <details className="entrance__more">
            <summary>With a token</summary>
            <TokenField signIn={signIn} />
          </details>
          <p className="muted entrance__foot">
            No account yet? Whoever runs this server can send you an invitation. Public datasets and
            leaderboards can be looked at without one.
          </p>
        </section>
      </div>
    </PageFrame>
  );
}
