import { describe, expect, it } from "vitest";
import { COMMANDS, keyCaps } from "./commands";
import { commandFor, type KeyPress, keyName } from "./keymap";

function press(key: string, modifiers: Partial<KeyPress> & { altGraph?: boolean } = {}): KeyPress {
  const { altGraph = false, ...rest } = modifiers;
  return {
    key,
    code: "",
    ctrlKey: false,
    metaKey: false,
    altKey: false,
    shiftKey: false,
    repeat: false,
    getModifierState: (name) => name === "AltGraph" && altGraph,
    ...rest,
  };
}

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

describe("commands", () => {
  it("have keys of their own", () => {
    const keys = COMMANDS.flatMap((command) => command.keys);
    expect(new Set(keys).size).toBe(keys.length);
  });

  it("leave Tab and Enter to buttons, but not letters", () => {
    expect(commandFor(press("Tab"), false)).toBeNull();
    expect(commandFor(press("Enter"), false)).toBeNull();
    expect(commandFor(press("Tab"), true)?.id).toBe("next");
    expect(commandFor(press("k"), false)?.id).toBe("keep");
  });

  it("leave the browser's own shortcuts alone", () => {
    expect(commandFor(press("r", { ctrlKey: true }), true)).toBeNull();
    expect(commandFor(press("a", { metaKey: true }), true)).toBeNull();
  });

  it("don't judge one candidate after another while a key is held", () => {
    expect(commandFor(press("x", { repeat: true }), true)).toBeNull();
    expect(commandFor(press("Tab", { repeat: true }), true)?.id).toBe("next");
  });

  it("show their keys as caps", () => {
    expect(keyCaps("Shift+Tab")).toEqual(["Shift", "Tab"]);
    expect(keyCaps("+")).toEqual(["+"]);
    expect(keyCaps("Escape")).toEqual(["Esc"]);
  });
});
