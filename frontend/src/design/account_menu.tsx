import { Link } from "react-router";
import { Icon, type IconName } from "./icons";

const FOR_ADMINS: readonly { to: string; icon: IconName; name: string }[] = [
  { to: "/people", icon: "people", name: "People" },
  { to: "/audit", icon: "clock", name: "Audit" },
  { to: "/status", icon: "chart", name: "Status" },
];

interface AccountMenuProps {
  /** Whether there is an account, and not a token alone. */
  account: boolean;
  admin: boolean;
  close: () => void;
}

/** The pages that concern one's account, and those that administrators have. */
export function AccountMenu({ account, admin, close }: AccountMenuProps) {
  if (!account && !admin) return null;
  return (
    <nav className="sign-in__menu" aria-label="Account">
      {account ? (
        <Link to="/account" className="menu-item" onClick={close}>
          <Icon name="person" /> Account
        </Link>
      ) : null}
      {admin
        ? FOR_ADMINS.map(({ to, icon, name }) => (
            <Link key={to} to={to} className="menu-item" onClick={close}>
              <Icon name={icon} /> {name}
            </Link>
          ))
        : null}
    </nav>
  );
}
