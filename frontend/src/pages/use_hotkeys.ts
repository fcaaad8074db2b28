import { useEffect, useRef } from "react";

const TYPING = "input:not([type=checkbox], [type=radio]), textarea, select, [contenteditable]";

type Hotkeys = Record<string, () => void>;

/** Single keys, by `KeyboardEvent.key` in lower case, wherever nothing is being typed. */
export function useHotkeys(hotkeys: Hotkeys): void {
  const latest = useRef(hotkeys);
  latest.current = hotkeys;
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target instanceof Element && event.target.closest(TYPING)) return;
      // Enter belongs to the button or field that has the focus.
      if (event.key === "Enter" && event.target !== document.body) return;
      const run = latest.current[event.key.toLowerCase()];
      if (!run) return;
      event.preventDefault();
      run();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, []);
}
