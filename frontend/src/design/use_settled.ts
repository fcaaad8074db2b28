import { useEffect, useState } from "react";

/**
 * A value once it has stayed the same for a while: whoever types, or goes from one thing to the next, doesn't want each
 * step looked up.
 *
 * @param first What counts before anything has settled.
 * @param pause ms.
 */
export function useSettled<T>(value: T, first: T, pause: number): T {
  const [settled, setSettled] = useState(first);
  useEffect(() => {
    const timer = setTimeout(() => setSettled(value), pause);
    return () => clearTimeout(timer);
  }, [value, pause]);
  return settled;
}
