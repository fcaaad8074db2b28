import { useEffect, useRef } from "react";

/** Browsers refuse more than about three changes of the address per second. */
const PAUSE = 500;

/** Keeps the page's address in step with what is shown, so that it can be shared; the history gets no entries of it. */
export function useViewerAddress(query: string): void {
  const latest = useRef(query);
  latest.current = query;
  const timer = useRef<ReturnType<typeof setTimeout> | null>(null);
  useEffect(() => {
    if (query === window.location.search || timer.current !== null) return;
    timer.current = setTimeout(() => {
      timer.current = null;
      writeNow(latest.current);
    }, PAUSE);
  }, [query]);
  useEffect(
    () => () => {
      if (timer.current !== null) clearTimeout(timer.current);
      timer.current = null;
    },
    [],
  );
}

function writeNow(query: string): void {
  if (query === window.location.search) return;
  window.history.replaceState(window.history.state, "", `${window.location.pathname}${query}`);
}
