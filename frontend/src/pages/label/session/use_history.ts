import { type QueryClient, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef } from "react";
import { getDecisions } from "../../../api/endpoints";
import { keys } from "../../../api/queries";
import { formatQuantity } from "../../../design/format";
import { toast } from "../../../design/toast";
import { firstPaint } from "../../../image_view/first_paint";
import { editedSegments } from "../../../labelling/drawing/edits";
import type { LabelStore } from "../../../labelling/label_store";
import { onDecisionsStored, outbox, seenDecisions } from "../../../labelling/outbox_start";
import { bringEdits } from "../drawing/known_edits";

/**
 * Brings the image's decisions from the server: after it is shown, for undo, and whenever one comes back to the
 * page, with what was decided in another tab or by another person in the meantime.
 *
 * @param news Another one means that others are at the image, too.
 * @returns Runs something once the history is known, or can't be had.
 */
export function useHistory(
  imageId: number,
  store: LabelStore | null,
  news: string | null,
): (act: () => void) => void {
  const queryClient = useQueryClient();
  const known = useRef<Promise<void>>(Promise.resolve());
  const bringAgain = useRef<() => void>(() => undefined);

  useEffect(() => {
    if (store === null) return;
    let running = false;
    let again = false;
    let left = false;
    const bring = (): Promise<void> => {
      if (left || document.visibilityState === "hidden") return Promise.resolve();
      again = running;
      if (running) return Promise.resolve();
      running = true;
      return catchUp(queryClient, imageId, store)
        .catch(() => undefined)
        .finally(() => {
          running = false;
          if (again) bring();
        });
    };
    known.current = firstPaint.whenPainted(imageId).then(bring);
    bringAgain.current = bring;
    const stopHearing = onDecisionsStored((id, { others }) => {
      if (id === imageId && others.length > 0) bring();
    });
    let stale = outbox.getStale();
    const stopWatching = outbox.subscribe(() => {
      if (outbox.getStale() === stale) return;
      stale = outbox.getStale();
      bring();
    });
    window.addEventListener("focus", bring);
    document.addEventListener("visibilitychange", bring);
    return () => {
      left = true;
      stopHearing();
      stopWatching();
      window.removeEventListener("focus", bring);
      document.removeEventListener("visibilitychange", bring);
    };
  }, [queryClient, imageId, store]);

  useEffect(() => {
    if (news !== null) bringAgain.current();
  }, [news]);

  return useCallback((act) => {
    known.current.then(act);
  }, []);
}

/** How often a decision that is made while the answer is on its way may make it out of date. */
const ATTEMPTS = 5;

async function catchUp(queryClient: QueryClient, imageId: number, store: LabelStore): Promise<void> {
  for (let attempt = 1; attempt <= ATTEMPTS; attempt++) {
    const before = store.getState().history;
    const unsent = outbox.pendingFor(imageId);
    const [{ decisions }, edits] = await Promise.all([
      getDecisions(imageId),
      bringEdits(queryClient, imageId, store),
    ]);
    if (store.getState().history !== before) continue;
    seenDecisions.raise(imageId, decisions.at(-1)?.id ?? 0);
    const { changed, replaced } = store.catchUp(decisions, unsent, editedSegments(edits));
    if (changed.length === 0) return;
    queryClient.invalidateQueries({ queryKey: keys.image(imageId), exact: true });
    tell(store, changed, replaced);
    return;
  }
}

function tell(store: LabelStore, changed: readonly number[], replaced: readonly number[]): void {
  const [first] = replaced.length > 0 ? replaced : changed;
  const verdicts = formatQuantity(changed.length, "verdict");
  toast({
    key: "caught-up",
    message:
      replaced.length === 0
        ? `${verdicts} from elsewhere`
        : `${verdicts} from elsewhere, ${replaced.length} in place of what stood here`,
    action: { label: "Show", run: () => store.select(first ?? null, { follow: true }) },
  });
}
