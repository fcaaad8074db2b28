/** Key presses for tests. */

import type { KeyPress } from "./keymap";

export function press(key: string, modifiers: Partial<KeyPress> & { altGraph?: boolean } = {}): KeyPress {
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
