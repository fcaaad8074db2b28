import { type RefObject, useEffect, useState } from "react";
import type { CanvasView } from "../../../canvas/view";
import type { LabelState } from "../../../labelling/label_state";

/** How long the view may move before what is on the screen is looked for again (ms). */
const PAUSE = 120;

/** Candidates on the screen, by index; a moment behind the view. */
export function useOnScreen(viewRef: RefObject<CanvasView | null>, state: LabelState): readonly number[] {
  const [indices, setIndices] = useState<readonly number[]>([]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: what is shown decides what the view has on the screen
  useEffect(() => {
    const view = viewRef.current;
    if (view === null) return;
    let timer: ReturnType<typeof setTimeout> | null = null;
    const look = () => {
      timer = null;
      setIndices(view.linesOnScreen());
    };
    const stop = view.watchMoves(() => {
      timer ??= setTimeout(look, PAUSE);
    });
    look();
    return () => {
      stop();
      if (timer !== null) clearTimeout(timer);
    };
  }, [viewRef, state.candidates, state.shown]);

  return indices;
}
