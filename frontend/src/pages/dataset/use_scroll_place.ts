import { type RefObject, useEffect, useRef } from "react";
import { useLocation, useNavigationType } from "react-router";

/** Going back to a page finds it scrolled to where it was left, once its content is there. */
export function useScrollPlace(scroller: RefObject<HTMLElement | null>, ready: boolean): void {
  const { key } = useLocation();
  const isReturn = useNavigationType() === "POP";
  const restored = useRef(false);
  const name = `clearlines.scroll.${key}`;

  useEffect(() => {
    const element = scroller.current;
    if (!element || !ready) return;
    if (isReturn && !restored.current) element.scrollTop = Number(sessionStorage.getItem(name) ?? 0);
    restored.current = true;
    const store = () => sessionStorage.setItem(name, String(Math.round(element.scrollTop)));
    element.addEventListener("scrollend", store);
    return () => element.removeEventListener("scrollend", store);
  }, [scroller, ready, isReturn, name]);
}
