import { useEffect, useRef } from "react";

/**
 * Calls `follow` after `progress` has changed, at most once in so many ms however often it changes.
 *
 * @param progress null while there is nothing to follow.
 */
export function useFollow(progress: string | null, milliseconds: number, follow: () => void): void {
  const latest = useRef(follow);
  latest.current = follow;
  const timer = useRef<ReturnType<typeof setTimeout> | null>(null);
  useEffect(() => {
    if (progress === null) return;
    timer.current ??= setTimeout(() => {
      timer.current = null;
      latest.current();
    }, milliseconds);
  }, [progress, milliseconds]);
  useEffect(
    () => () => {
      if (timer.current !== null) clearTimeout(timer.current);
      timer.current = null;
    },
    [],
  );
}
