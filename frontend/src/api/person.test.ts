import { beforeEach, describe, expect, it } from "vitest";
import { choosePerson, chosenPerson, PERSON_HEADER, personHeaders } from "./person";

let kept: Map<string, string>;
const storage = () =>
  ({
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
    removeItem: (key: string) => kept.delete(key),
  }) as unknown as Storage;

beforeEach(() => {
  kept = new Map();
});

describe("the chosen name", () => {
  it("is kept in one form, and given up by an empty one", () => {
    expect(chosenPerson(storage)).toBeNull();
    choosePerson("  Zoe\u0308   Müller ", storage);
    expect(chosenPerson(storage)).toBe("Zoë Müller");
    choosePerson("  ", storage);
    expect(chosenPerson(storage)).toBeNull();
  });

  it("needs no storage", () => {
    const forbidden = () => {
      throw new DOMException("forbidden", "SecurityError");
    };
    choosePerson("Mara", forbidden);
    expect(chosenPerson(forbidden)).toBeNull();
  });

  it("goes through a header as ASCII", () => {
    expect(personHeaders("Zoë")).toEqual({ [PERSON_HEADER]: "Zo%C3%AB" });
    expect(personHeaders(null)).toEqual({});
  });
});
