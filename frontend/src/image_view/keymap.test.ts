import { describe, expect, it } from "vitest";
import { keyCaps } from "./commands";
import { keyName } from "./keymap";
import { press } from "./test_keys";

describe("key names", () => {
  it.each([
    ["a letter, with caps lock or without", press("K"), "K"],
    ["a letter", press("k"), "K"],
    ["Shift and a letter", press("Z", { shiftKey: true }), "Shift+Z"],
    ["a character that needs Shift", press("?", { shiftKey: true }), "?"],
    ["Shift and a named key", press("Tab", { shiftKey: true }), "Shift+Tab"],
    ["Command on a Mac", press("z", { metaKey: true }), "Ctrl+Z"],
    ["AltGr on a German keyboard", press("[", { ctrlKey: true, altKey: true, altGraph: true }), "["],
    ["an input method", press("Process", { code: "KeyK" }), "K"],
    ["a Cyrillic layout", press("л", { code: "KeyK" }), "K"],
  ])("of %s", (_, event, name) => {
    expect(keyName(event)).toBe(name);
  });
});

describe("key caps", () => {
  it("of combinations, of the plus and of named keys", () => {
    expect(keyCaps("Shift+Tab")).toEqual(["Shift", "Tab"]);
    expect(keyCaps("+")).toEqual(["+"]);
    expect(keyCaps("Escape")).toEqual(["Esc"]);
  });
});
