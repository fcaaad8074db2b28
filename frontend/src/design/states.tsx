import type { ReactNode } from "react";
import { asProblem } from "../api/problem";
import { Button } from "./button";
import { sentence } from "./format";
import { Icon, type IconName } from "./icons";

interface EmptyStateProps {
  icon: IconName;
  title: string;
  children?: ReactNode;
  actions?: ReactNode;
}

export function EmptyState({ icon, title, children, actions }: EmptyStateProps) {
  return (
    <section className="state">
      <span className="state__icon">
        <Icon name={icon} size={22} />
      </span>
      <h2>{title}</h2>
      {children ? <div className="state__text">{children}</div> : null}
      {actions ? <div className="state__actions">{actions}</div> : null}
    </section>
  );
}

interface ErrorStateProps {
  error: unknown;
  /** Where the error brings no title of its own. */
  title?: string;
  onRetry?: () => void;
  actions?: ReactNode;
}

/** A problem with everything the server said about it, and a way on. */
export function ErrorState({ error, title, onRetry, actions }: ErrorStateProps) {
  const problem = asProblem(error, title);
  const facts = [
    ["Where", problem.where],
    ["Expected", problem.expected],
  ].filter(([, text]) => text);
  return (
    <section className="state state--error" role="alert">
      <span className="state__icon">
        <Icon name="warning" size={22} />
      </span>
      <h2>{problem.title}</h2>
      <p className="state__text">{sentence(problem.message)}</p>
      {facts.length > 0 ? (
        <dl className="state__facts">
          {facts.map(([name, text]) => (
            <div key={name}>
              <dt>{name}</dt>
              <dd>{text}</dd>
            </div>
          ))}
        </dl>
      ) : null}
      {problem.hint ? <p className="state__text">{sentence(problem.hint)}</p> : null}
      <div className="state__actions">
        {onRetry ? (
          <Button icon="retry" onClick={onRetry}>
            Try again
          </Button>
        ) : null}
        {actions}
      </div>
    </section>
  );
}

export function LoadingState({ label }: { label: string }) {
  return (
    <div className="state" role="status">
      <span className="spinner" aria-hidden="true" />
      <p className="state__text">{label}</p>
    </div>
  );
}
