/** From a key event to the command it stands for. */

import type { Command } from "./commands";

export interface KeyPress {
  readonly key: string;
  readonly code: string;
  readonly ctrlKey: boolean;
  readonly metaKey: boolean;
  readonly altKey: boolean;
  readonly shiftKey: boolean;
  readonly repeat: boolean;
  getModifierState(name: string): boolean;
}

/** Commands by the names of their keys. */
export type Keymap<Actions> = ReadonlyMap<string, Command<Actions>>;

export function keymapOf<Actions>(commands: readonly Command<Actions>[]): Keymap<Actions> {
  return new Map(commands.flatMap((command) => command.keys.map((key) => [key, command] as const)));
}

/** @param onImage Whether the image has the focus, or nothing has. */
export function commandFor<Actions>(
  keymap: Keymap<Actions>,
  press: KeyPress,
  onImage: boolean,
): Command<Actions> | null {
  const command = keymap.get(keyName(press));
  if (command === undefined) return null;
  if (command.onImageOnly && !onImage) return null;
  if (press.repeat && !command.repeats) return null;
  return command;
}

/** The name of a key press as in the commands: "K", "Shift+Z", "Ctrl+Y", "?". */
export function keyName(press: KeyPress): string {
  // AltGr types characters such as "[" on many keyboards; it isn't Alt and Ctrl then.
  const altGraph = press.getModifierState("AltGraph");
  const letter = letterOf(press);
  const key = letter ?? press.key;
  const parts: string[] = [];
  if ((press.ctrlKey || press.metaKey) && !altGraph) parts.push("Ctrl");
  if (press.altKey && !altGraph) parts.push("Alt");
  // For other characters Shift is part of typing them: "?" is what was meant, not "Shift+?".
  if (press.shiftKey && (letter !== null || press.key.length > 1)) parts.push("Shift");
  return [...parts, key].join("+");
}

/** A Latin letter; on other scripts' layouts, and under an input method, the one printed at that place. */
function letterOf({ key, code }: KeyPress): string | null {
  if (/^[a-z]$/i.test(key)) return key.toUpperCase();
  const isOtherScript = (key.length === 1 && key.charCodeAt(0) > 127) || key === "Process";
  return isOtherScript && /^Key[A-Z]$/.test(code) ? code.slice(3) : null;
}
