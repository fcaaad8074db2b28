import { capitalized } from "../../design/format";

const LONGEST = 160;

/** "user.role_changed" as "User: role changed". */
export function kindText(kind: string): string {
  const [thing = "", ...happened] = kind.split(".");
  const what = happened.join(" ").replaceAll("_", " ");
  const subject = capitalized(thing.replaceAll("_", " ").replaceAll("-", " "));
  return what ? `${subject}: ${what}` : subject;
}

/** Facts of a line: "name: ada, role: annotator". */
export function detailText(details: Readonly<Record<string, unknown>>): string {
  const text = Object.entries(details)
    .filter(([, value]) => value !== null && value !== undefined)
    .map(([name, value]) => `${name.replaceAll("_", " ")}: ${plain(value)}`)
    .join(", ");
  return text.length > LONGEST ? `${text.slice(0, LONGEST - 1)}…` : text;
}

function plain(value: unknown): string {
  if (Array.isArray(value)) return value.map(plain).join(" ");
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}
