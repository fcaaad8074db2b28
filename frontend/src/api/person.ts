/** The name that somebody chose in this browser, where the server asks for no token; a token has its own. */

export const PERSON_HEADER = "X-ClearLines-Person";
export const LONGEST_NAME = 80;
const KEY = "clearlines-person";

/** The chosen name; null before one was chosen, or where the browser keeps nothing. */
export function chosenPerson(storage: () => Storage = () => localStorage): string | null {
  try {
    return storage().getItem(KEY);
  } catch {
    return null;
  }
}

/** Keeps a name in the form in which the server has it; an empty one gives it up. */
export function choosePerson(name: string, storage: () => Storage = () => localStorage): void {
  const chosen = name.normalize("NFC").trim().replace(/ +/g, " ");
  try {
    if (chosen === "") storage().removeItem(KEY);
    else storage().setItem(KEY, chosen);
  } catch {
    // The browser forbids storage: the name isn't kept, everything else works.
  }
}

/** What every request says of the person. */
export function personHeaders(person = chosenPerson()): Record<string, string> {
  return person === null ? {} : { [PERSON_HEADER]: encodeURIComponent(person) };
}
