/** The kinds of errors, as the server names them, and what they are called. */

export interface ErrorType {
  type: string;
  /** "over-extended": within a sentence. */
  name: string;
  /** Of many: what they have in common. */
  meaning: string;
  /** Of one: why it counts as an error. */
  why: string;
}

const errorType = (type: string, name: string, meaning: string, why: string): ErrorType => ({
  type,
  name,
  meaning,
  why,
});

export const FALSE_POSITIVES: readonly ErrorType[] = [
  errorType("background", "background", "No label is near.", "Nothing like it was labelled."),
  errorType(
    "offset",
    "offset",
    "Along a label, but too far beside it.",
    "It lies beside a label, too far away.",
  ),
  errorType("wrong_angle", "wrong angle", "Near a label, but turned.", "It lies near a label, but turned."),
  errorType(
    "over_extended",
    "over-extended",
    "Runs on far beyond its label.",
    "It runs on beyond its label, or over several labels.",
  ),
  errorType(
    "fragment",
    "fragment",
    "A piece of a label, too short to count.",
    "It covers too small a part of its label.",
  ),
  errorType(
    "duplicate",
    "duplicate",
    "A label that another prediction has found.",
    "Another prediction counts for its label already.",
  ),
];

export const FALSE_NEGATIVES: readonly ErrorType[] = [
  errorType("missed", "missed", "Nothing was found there.", "Predictions cover less than half of it."),
  errorType(
    "fragmented",
    "fragmented",
    "Found in pieces, none of them long enough.",
    "Pieces of it were found, none of them enough alone.",
  ),
];

const BY_TYPE = new Map([...FALSE_POSITIVES, ...FALSE_NEGATIVES].map((known) => [known.type, known]));

/** The kind of error in words; of a kind that isn't known here, its name alone; null where it isn't an error. */
export function errorTypeOf(type: string | null): Pick<ErrorType, "name" | "why"> | null {
  if (type === null) return null;
  return BY_TYPE.get(type.replaceAll("-", "_")) ?? { name: type.replaceAll("_", " "), why: "" };
}
