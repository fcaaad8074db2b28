import type { Present } from "../../../api/people_endpoints";
import { Icon } from "../../../design/icons";
import "./people.css";

/** Says in the page's frame who else has the image open. */
export function Presence({ others }: { others: readonly Present[] }) {
  return (
    <span className="presence-region" aria-live="polite">
      {others.length > 0 ? (
        <span className="presence" title={others.map(nameOf).join(", ")}>
          <Icon name="person" /> <span>{presenceText(others.map(nameOf))}</span>
        </span>
      ) : null}
    </span>
  );
}

/** "Mara is here", "Mara and Jon are here", "Mara and 2 others are here". */
export function presenceText(names: readonly string[]): string {
  const [first, second, ...rest] = names;
  if (second === undefined) return `${first} is here`;
  return rest.length === 0
    ? `${first} and ${second} are here`
    : `${first} and ${names.length - 1} others are here`;
}

function nameOf({ person }: Present): string {
  return person ?? "Someone";
}
