import { useQuery } from "@tanstack/react-query";
import { Link, useLocation } from "react-router";
import { signIn } from "../api/board_endpoints";
import { meQuery } from "../api/board_queries";
import type { Me } from "../api/board_types";
import { chosenPerson } from "../api/person";
import { AccountMenu } from "./account_menu";
import { buttonClass } from "./button";
import { PersonForm } from "./person_form";
import { Popover } from "./popover";
import { MAY } from "./roles";
import { SignOut } from "./sign_out";
import { TokenField } from "./token_field";
import "./sign_in.css";

/** Who is signed in, and what is theirs alone; else the way to sign in. */
export function SignIn() {
  const me = useQuery(meQuery);
  if (!me.data) return null;
  if (!me.data.anonymous) return <SignedIn me={me.data} />;
  return me.data.hosted ? <WayIn /> : <InLocalMode role={me.data.role} admin={me.data.can.admin} />;
}

function WayIn() {
  const { pathname, search } = useLocation();
  if (pathname === "/sign-in") return null;
  return (
    <Link to={`/sign-in?next=${encodeURIComponent(pathname + search)}`} className={buttonClass()}>
      Sign in
    </Link>
  );
}

function SignedIn({ me: { name, role, account, can } }: { me: Me }) {
  return (
    <Popover label={`${name}, ${role}`} icon="person" iconOnly tone="quiet">
      {(close) => (
        <div className="sign-in">
          <p className="sign-in__who">
            <strong>{name}</strong>
            <span className="badge">{role}</span>
          </p>
          <p className="muted">{MAY[role]}</p>
          <AccountMenu account={account !== null} admin={can.admin} close={close} />
          <SignOut close={close} />
        </div>
      )}
    </Popover>
  );
}

/** On one's own computer nobody signs in; a name says who decided. */
function InLocalMode({ role, admin }: { role: Me["role"]; admin: boolean }) {
  const chosen = admin ? chosenPerson() : null;
  const shown = admin ? "owner" : role;
  const label = chosen ?? (admin ? `Not signed in, ${shown}` : "Sign in");
  return (
    <Popover label={label} icon="person" iconOnly={admin && chosen === null} tone="quiet">
      {(close) => (
        <div className="sign-in">
          <p className="sign-in__who">
            <strong>{chosen ?? "Not signed in"}</strong>
            <span className="badge">{shown}</span>
          </p>
          {admin ? <PersonForm close={close} /> : null}
          <p className="muted">
            {admin ? "On this computer everything is allowed without a token." : MAY[role]}
          </p>
          {admin ? <AccountMenu account={false} admin close={close} /> : null}
          <TokenField signIn={signIn} close={close} />
        </div>
      )}
    </Popover>
  );
}
