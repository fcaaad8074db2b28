import { splitForEllipsis } from "../design/format";

const LONGEST_BEGINNING = 40;
const END = 20;

/** A long name without its middle: names of one folder differ at their end. */
export function shortName(name: string): string {
  const [beginning, end] = splitForEllipsis(name, END);
  return beginning.length <= LONGEST_BEGINNING ? name : `${beginning.slice(0, LONGEST_BEGINNING)}…${end}`;
}
