import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { Link, useLocation, useNavigate } from "react-router";
import { acceptInvitation, startWithProvider } from "../../api/account_endpoints";
import { invitationQuery, providersQuery } from "../../api/account_queries";
import type { InvitationLook } from "../../api/account_types";
import { Button, buttonClass } from "../../design/button";
import { EntranceForm } from "../../design/entrance_form";
import { formatDate } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { PasswordField } from "../../design/password_field";
import { MAY } from "../../design/roles";
import { EmptyState, ErrorState } from "../../design/states";
import { useSigningIn } from "../../design/use_signing_in";
import { failed } from "../datasets/use_dataset_actions";
import { Fetched, PageSkeleton } from "../fetched";
import "../entrance.css";
import "../board_page.css";

/** What an invitation's link opens: a name and a password make the account. The secret stays behind the #. */
export function InvitationPage() {
  const secret = useLocation().hash.slice(1);
  const look = useQuery({ ...invitationQuery(secret), enabled: secret !== "" });
  return (
    <PageFrame crumbs={[{ label: "Invitation" }]}>
      <div className="entrance">
        {secret === "" ? (
          <ErrorState error={new Error("The link isn't whole: what follows the # is missing")} />
        ) : (
          <Fetched query={look} missing={<NotGood />} loading={<PageSkeleton what="the invitation" />}>
            {(invitation) => <Accept secret={secret} invitation={invitation} />}
          </Fetched>
        )}
      </div>
    </PageFrame>
  );
}

function NotGood() {
  return (
    <EmptyState
      icon="clock"
      title="This invitation is not good any more"
      actions={
        <Link to="/sign-in" className={buttonClass("primary")}>
          Sign in
        </Link>
      }
    >
      It was used already, taken back, or has expired. Ask whoever sent it for a new one.
    </EmptyState>
  );
}

function Accept({ secret, invitation }: { secret: string; invitation: InvitationLook }) {
  const { kind, role, name: fixed, expires_at } = invitation;
  const [name, setName] = useState(fixed ?? "");
  const [password, setPassword] = useState("");
  const enter = useSigningIn();
  const navigate = useNavigate();
  const joins = kind === "join";
  const submit = async () => {
    await enter(() => acceptInvitation(secret, joins && fixed === null ? name.trim() : null, password));
    navigate("/", { replace: true });
  };
  return (
    <section className="entrance__card card" aria-labelledby="invitation-title">
      <h1 id="invitation-title">{joins ? "You are invited" : "A new password"}</h1>
      <p className="muted">
        {joins && role ? (
          <>
            Your account will be that of {role === "admin" || role === "annotator" ? "an" : "a"}{" "}
            <strong>{role}</strong>, who {MAY[role].replace("May", "may")}
          </>
        ) : (
          <>
            For the account <strong>{fixed}</strong>. Wherever else it is signed in, it is signed out.
          </>
        )}
      </p>
      <EntranceForm
        submitLabel={joins ? "Make the account" : "Set the password"}
        ready={name.trim() !== "" && password !== ""}
        submit={submit}
      >
        <label className="field">
          <span className="field__label">Name</span>
          <input
            className="input"
            autoComplete="username"
            spellCheck={false}
            readOnly={fixed !== null}
            maxLength={80}
            value={name}
            onChange={(event) => setName(event.target.value)}
          />
          {fixed === null ? (
            <span className="field__hint">What you do is stored under it; it can't be changed later.</span>
          ) : null}
        </label>
        <PasswordField
          label="Password"
          kind="new"
          hint="At least 10 characters; several words are fine."
          value={password}
          onChange={setPassword}
        />
      </EntranceForm>
      {joins ? <ProviderButtons secret={secret} /> : null}
      <p className="muted entrance__foot">The link is good once, until {formatDate(expires_at)}.</p>
    </section>
  );
}

/** An account without a password: whoever the provider says it is. */
function ProviderButtons({ secret }: { secret: string }) {
  const providers = useQuery(providersQuery);
  if (!providers.data || providers.data.length === 0) return null;
  const go = async () => {
    try {
      window.location.assign(await startWithProvider(secret));
    } catch (error) {
      failed(error);
    }
  };
  return (
    <>
      <p className="entrance__or muted">or</p>
      {providers.data.map(({ name, start }) => (
        <Button key={start} onClick={() => void go()}>
          Sign in with {name}
        </Button>
      ))}
    </>
  );
}
