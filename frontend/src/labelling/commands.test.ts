import { describe, expect, it } from "vitest";
import { commandFor } from "../image_view/keymap";
import { press } from "../image_view/test_keys";
import { COMMANDS, KEYMAP } from "./commands";

describe("commands of the label page", () => {
  it("have keys of their own", () => {
    const keys = COMMANDS.flatMap((command) => command.keys);
    expect(new Set(keys).size).toBe(keys.length);
  });

  it("leave Tab and Enter to buttons, but not letters", () => {
    expect(commandFor(KEYMAP, press("Tab"), false)).toBeNull();
    expect(commandFor(KEYMAP, press("Enter"), false)).toBeNull();
    expect(commandFor(KEYMAP, press("Tab"), true)?.id).toBe("next");
    expect(commandFor(KEYMAP, press("k"), false)?.id).toBe("keep");
  });

  it("leave the browser's own shortcuts alone", () => {
    expect(commandFor(KEYMAP, press("r", { ctrlKey: true }), true)).toBeNull();
    expect(commandFor(KEYMAP, press("s", { metaKey: true }), true)).toBeNull();
  });

  it("don't judge one candidate after another while a key is held", () => {
    expect(commandFor(KEYMAP, press("x", { repeat: true }), true)).toBeNull();
    expect(commandFor(KEYMAP, press("Tab", { repeat: true }), true)?.id).toBe("next");
  });
});
