import { describe, expect, it } from "vitest";
import { readSuggestionPreferences, thresholdsFor, writeSuggestionPreferences } from "./preferences";

function storageWith(text: string | null): Storage {
  let kept = text;
  return {
    getItem: () => kept,
    setItem: (_key: string, value: string) => {
      kept = value;
    },
  } as unknown as Storage;
}

describe("preferences of suggestions", () => {
  it("come back as they were written", () => {
    const storage = storageWith(null);
    writeSuggestionPreferences(storage, { shown: false, keep: 0.9, reject: null });
    expect(readSuggestionPreferences(storage)).toEqual({ shown: false, keep: 0.9, reject: null });
  });

  it("are the model's own where nothing, or nonsense, is stored", () => {
    const usual = { shown: true, keep: null, reject: null };
    expect(readSuggestionPreferences(storageWith(null))).toEqual(usual);
    expect(readSuggestionPreferences(storageWith("{"))).toEqual(usual);
    expect(readSuggestionPreferences(storageWith('{"shown": 1, "keep": 0.1, "reject": "a"}'))).toEqual(usual);
  });

  it("take the place of what the model recommends, each for itself", () => {
    const recommended = { keep: 0.8, reject: 0.2 };
    expect(thresholdsFor({ shown: true, keep: null, reject: 0.4 }, recommended)).toEqual({
      keep: 0.8,
      reject: 0.4,
    });
  });
});
