/** How often a picture that costs much follows a moving hand (ms). */
const PAUSE = 60;

/**
 * Returns what calls `act` at once where it hasn't been called for a while, else once that is so; and what forgets a
 * call that is still to come.
 */
export function calmly(act: () => void): { readonly call: () => void; readonly forget: () => void } {
  let timer: ReturnType<typeof setTimeout> | null = null;
  let wanted = false;

  function pause(): void {
    timer = setTimeout(() => {
      timer = null;
      if (!wanted) return;
      wanted = false;
      act();
      pause();
    }, PAUSE);
  }

  return {
    call: () => {
      if (timer === null) {
        act();
        pause();
      } else wanted = true;
    },
    forget: () => {
      if (timer !== null) clearTimeout(timer);
      timer = null;
      wanted = false;
    },
  };
}
