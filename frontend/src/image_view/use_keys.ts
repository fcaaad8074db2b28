import { type RefObject, useEffect } from "react";
import { commandFor, type Keymap } from "./keymap";

const IMAGE = ".image-canvas";
const TYPING =
  'input:not([type="radio"], [type="checkbox"], [type="range"]), textarea, select, [contenteditable]';

/** Keys act wherever nothing is being typed; Tab, Enter and arrows only while the image has the focus. */
export function useKeys<Actions>(keymap: Keymap<Actions>, actions: Actions): void {
  useEffect(() => {
    function onKeyDown(event: KeyboardEvent): void {
      const target = event.target instanceof Element ? event.target : document.body;
      if (event.defaultPrevented || target.closest(TYPING)) return;
      const onImage = target === document.body || target.matches(IMAGE);
      const command = commandFor(keymap, event, onImage);
      if (command === null) return;
      event.preventDefault();
      command.run(actions);
    }
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, [keymap, actions]);
}

/** After a click on a button the image has the focus again, so that Tab goes on with the lines. */
export function useFocusBackAfterClick(regionRef: RefObject<HTMLElement | null>): void {
  useEffect(() => {
    function onClick(event: MouseEvent): void {
      // A click made by Enter or Space has no detail: the focus then stays where the keyboard is.
      if (event.detail === 0 || !(event.target instanceof Element)) return;
      // An image takes the focus by itself.
      if (event.target.closest(IMAGE)) return;
      // What was clicked may have opened a field that has the focus now.
      if (event.target.closest(TYPING) || document.activeElement?.matches(TYPING)) return;
      regionRef.current?.focus({ preventScroll: true });
    }
    window.addEventListener("click", onClick);
    return () => window.removeEventListener("click", onClick);
  }, [regionRef]);
}
