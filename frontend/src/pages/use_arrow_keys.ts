import { type RefObject, useEffect } from "react";

/** Arrow keys move the focus among the elements that match, by where they lie on the page. */
export function useArrowKeys(container: RefObject<HTMLElement | null>, selector: string): void {
  useEffect(() => {
    const root = container.current;
    if (!root) return;
    const onKeyDown = (event: KeyboardEvent) => {
      const focused = document.activeElement;
      if (!(focused instanceof HTMLElement) || !focused.matches(selector)) return;
      const all = [...root.querySelectorAll<HTMLElement>(selector)];
      const next = neighbour(all, focused, event.key);
      if (!next) return;
      event.preventDefault();
      next.focus();
    };
    root.addEventListener("keydown", onKeyDown);
    return () => root.removeEventListener("keydown", onKeyDown);
  }, [container, selector]);
}

function neighbour(all: HTMLElement[], focused: HTMLElement, key: string): HTMLElement | undefined {
  const index = all.indexOf(focused);
  if (key === "ArrowRight") return all[index + 1];
  if (key === "ArrowLeft") return all[index - 1];
  if (key === "Home") return all[0];
  if (key === "End") return all.at(-1);
  if (key !== "ArrowDown" && key !== "ArrowUp") return undefined;
  const here = focused.getBoundingClientRect();
  const down = key === "ArrowDown";
  const rows = all
    .map((element) => ({ element, box: element.getBoundingClientRect() }))
    .filter(({ box }) => (down ? box.top > here.top + 1 : box.top < here.top - 1))
    .sort((a, b) => Math.abs(a.box.top - here.top) - Math.abs(b.box.top - here.top));
  const nearest = rows[0]?.box.top;
  return rows
    .filter(({ box }) => nearest !== undefined && Math.abs(box.top - nearest) < 2)
    .sort((a, b) => Math.abs(a.box.left - here.left) - Math.abs(b.box.left - here.left))[0]?.element;
}
