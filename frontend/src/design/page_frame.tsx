import { type ReactNode, useEffect } from "react";
import { Link, useLocation } from "react-router";
import { Icon, type IconName, Logo } from "./icons";
import { SignIn } from "./sign_in";
import { ThemeToggle } from "./theme_toggle";

export interface Crumb {
  label: string;
  /** Absent on the page itself. */
  to?: string;
}

const AREAS: readonly { to: string; name: string; icon: IconName; within: RegExp }[] = [
  { to: "/", name: "Datasets", icon: "images", within: /^\/($|datasets)/ },
  {
    to: "/splits",
    name: "Leaderboards",
    icon: "podium",
    within: /^\/(splits|submissions|methods|docs\/scoring)/,
  },
];

interface PageFrameProps {
  crumbs: Crumb[];
  /** Right side of the bar, before the theme: state of saving, page-wide buttons. */
  actions?: ReactNode;
  /** The page scrolls as a whole; the label page doesn't. */
  scrolling?: boolean;
  children: ReactNode;
}

/** The bar with product name and breadcrumbs, and the page below it. */
export function PageFrame({ crumbs, actions, scrolling = true, children }: PageFrameProps) {
  const { pathname } = useLocation();
  const title = crumbs.at(-1)?.label;
  useEffect(() => {
    document.title = title ? `${title} - ClearLines` : "ClearLines";
  }, [title]);
  return (
    <div className={`frame${scrolling ? " frame--scrolling" : ""}`}>
      <header className="top-bar">
        <Link to="/" className="top-bar__logo" aria-label="ClearLines, all datasets">
          <Logo />
          <span className="top-bar__name">ClearLines</span>
        </Link>
        <nav className="breadcrumbs" aria-label="Breadcrumbs">
          <ol>
            {crumbs.map((crumb) => (
              <li key={`${crumb.to ?? ""}${crumb.label}`}>
                {crumb.to ? (
                  <Link to={crumb.to}>{crumb.label}</Link>
                ) : (
                  <span aria-current="page">{crumb.label}</span>
                )}
              </li>
            ))}
          </ol>
        </nav>
        <div className="top-bar__end">
          {actions}
          <nav className="top-bar__areas" aria-label="Areas">
            {AREAS.map(({ to, name, icon, within }) => (
              <Link
                key={to}
                to={to}
                className="top-bar__area"
                aria-current={within.test(pathname)}
                title={name}
              >
                <Icon name={icon} />
                <span className="top-bar__area-name">{name}</span>
              </Link>
            ))}
          </nav>
          <SignIn />
          <ThemeToggle />
        </div>
      </header>
      <main className="frame__content">{children}</main>
    </div>
  );
}
