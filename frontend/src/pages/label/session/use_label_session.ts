/** The data of the image under review, from the server and the outbox, and that of its neighbours. */

import {
  type QueryClient,
  queryOptions,
  usePrefetchQuery,
  useQuery,
  useQueryClient,
} from "@tanstack/react-query";
import { useEffect, useMemo, useRef } from "react";
import { meQuery } from "../../../api/board_queries";
import { displayUrl } from "../../../api/endpoints";
import { imageQuery, keys, suggestionsQuery } from "../../../api/queries";
import type { ImageDetail } from "../../../api/types";
import { linePainter } from "../../../canvas/line_painter_start";
import { getPalette } from "../../../design/palette";
import { firstPaint } from "../../../image_view/first_paint";
import { imageLoader } from "../../../image_view/use_image_bitmap";
import { type Annotations, loadAnnotations } from "../../../labelling/annotations";
import { candidateLook } from "../../../labelling/candidate_look";
import type { LabelStore } from "../../../labelling/label_store";
import { openLabelStore } from "../../../labelling/open_store";
import { onDecisionsStored, outbox, seenDecisions } from "../../../labelling/outbox_start";
import { readPreferences } from "../../../labelling/preferences";
import { stopwatch } from "../../../labelling/stopwatch_start";
import { bringSuggestions } from "../../../labelling/suggestions/bring_suggestions";
import { readSuggestionPreferences } from "../../../labelling/suggestions/preferences";
import { NOTHING_TOUCHED } from "../../../labelling/tools/preview";

const POLL = 1_500;

export const annotationsKey = (imageId: number) => [...keys.image(imageId), "annotations"] as const;

const annotationsQuery = (imageId: number) =>
  queryOptions({
    queryKey: annotationsKey(imageId),
    queryFn: () => currentAnnotations(imageId),
    // The store made of it is the truth from here on; fetching again would throw its selection away.
    staleTime: Number.POSITIVE_INFINITY,
  });

/**
 * The candidates with all verdicts that were given here. To learn whether some wait to be sent takes the browser as long
 * as all else: the server is asked meanwhile, and once more where there were some.
 */
async function currentAnnotations(imageId: number): Promise<Annotations> {
  const unsent = outbox.ready.then(() => outbox.pendingFor(imageId).length > 0);
  const annotations = await drawnAnnotations(imageId);
  if (!(await unsent)) return annotations;
  // Without a network the next request says so itself.
  await outbox.flush().catch(() => undefined);
  return drawnAnnotations(imageId);
}

async function drawnAnnotations(imageId: number): Promise<Annotations> {
  const annotations = await loadAnnotations(imageId);
  prepareLines(annotations);
  return annotations;
}

/** Has the lines drawn as they will be seen when the image is opened. */
function prepareLines(annotations: Annotations): void {
  const { imageWidth: width, imageHeight: height, scene } = annotations;
  const look = candidateLook(storeOf(annotations).getState(), NOTHING_TOUCHED, getPalette());
  linePainter.prepare(scene, look, { width, height });
}

export interface LabelSession {
  image: ImageDetail | undefined;
  annotations: Annotations | undefined;
  store: LabelStore | null;
  error: unknown;
  retry: () => void;
}

export function useLabelSession(slug: string, imageId: number): LabelSession {
  const queryClient = useQueryClient();
  // Asked for while the page is rendered, not once an empty one has been painted.
  usePrefetchQuery(imageQuery(imageId));
  usePrefetchQuery(annotationsQuery(imageId));
  usePrefetchQuery(meQuery);
  const image = useQuery({
    ...imageQuery(imageId),
    refetchInterval: ({ state }) => (isUnderWay(state.data) ? POLL : false),
  });
  const annotations = useQuery(annotationsQuery(imageId));
  const data = annotations.data;

  // Together with the rest, not after it: whatever goes wrong is said by who shows it.
  useMemo(() => {
    imageLoader.load(displayUrl(imageId)).catch(() => undefined);
  }, [imageId]);

  const store = useMemo(() => (data === undefined ? null : storeOf(data)), [data]);
  const shownImage = useRef(image.data);
  shownImage.current = image.data;

  usePrefetch(queryClient, image.data, data !== undefined);
  useReloadAfterRun(queryClient, image.data);
  useStoredStatus(queryClient);

  useEffect(
    () => () => {
      forgetLater(queryClient, slug, imageId).then(() => {
        const shown = shownImage.current;
        if (shown !== undefined && neighboursOf(shown).includes(imageId)) prefetch(queryClient, imageId);
      });
    },
    [queryClient, slug, imageId],
  );

  return {
    image: image.data,
    annotations: data,
    store,
    error: image.error ?? annotations.error,
    retry: () => {
      image.refetch();
      annotations.refetch();
    },
  };
}

/** Going back to an image that is still in memory finds it as it was left, selection included. */
const stores = new WeakMap<Annotations, LabelStore>();

function storeOf(annotations: Annotations): LabelStore {
  const store = stores.get(annotations) ?? openStore(annotations);
  stores.set(annotations, store);
  return store;
}

function openStore(annotations: Annotations): LabelStore {
  const { order, shown } = readPreferences(localStorage);
  seenDecisions.raise(annotations.imageId, annotations.lastDecisionId);
  return openLabelStore(annotations, {
    pending: outbox.pendingFor(annotations.imageId),
    order,
    shown,
    stopwatch,
    newId: () => crypto.randomUUID(),
    record: (decisions) => outbox.add(annotations.imageId, decisions, seenDecisions.of(annotations.imageId)),
  });
}

function isUnderWay(image: ImageDetail | undefined): boolean {
  return image?.prelabel === "queued" || image?.prelabel === "running";
}

/** Images that one may go to next, the likeliest first. */
function neighboursOf({ id, next_open_id, next_id, previous_id }: ImageDetail): number[] {
  const ids = new Set([next_open_id, next_id, previous_id]);
  return [...ids].filter((other) => other !== null && other !== id) as number[];
}

/** What comes next is fetched once this image is there: it must not have to share the server. */
function usePrefetch(queryClient: QueryClient, image: ImageDetail | undefined, annotated: boolean): void {
  const latest = useRef(image);
  latest.current = image;
  const neighbours = image === undefined || !annotated ? "" : neighboursOf(image).join();
  useEffect(() => {
    let wanted = true;
    const run = async () => {
      const shown = latest.current;
      if (shown === undefined) return;
      await firstPaint.whenPainted(shown.id);
      for (const id of neighbours.split(",")) {
        if (wanted && id !== "") await prefetch(queryClient, Number(id));
      }
    };
    run();
    return () => {
      wanted = false;
    };
  }, [queryClient, neighbours]);
}

async function prefetch(queryClient: QueryClient, id: number): Promise<void> {
  const image = await queryClient.fetchQuery(imageQuery(id)).catch(() => null);
  if (image === null) return;
  await Promise.all([
    queryClient.prefetchQuery(annotationsQuery(id)),
    queryClient.prefetchQuery(suggestionsQuery(id)),
    imageLoader.prefetch(displayUrl(id), image),
  ]);
  const annotations = queryClient.getQueryData(annotationsQuery(id).queryKey);
  const suggestions = queryClient.getQueryData(suggestionsQuery(id).queryKey);
  if (annotations === undefined || suggestions === undefined) return;
  bringSuggestions(storeOf(annotations), suggestions, readSuggestionPreferences(localStorage));
  // Once more, for what is suggested is drawn too.
  prepareLines(annotations);
}

/** A run that finishes, seen or unseen, while the image is open brings other candidates. */
function useReloadAfterRun(queryClient: QueryClient, image: ImageDetail | undefined): void {
  const known = useRef<{ id: number; prelabel: string; run: number | undefined } | null>(null);
  useEffect(() => {
    if (image === undefined) return;
    const before = known.current;
    known.current = { id: image.id, prelabel: image.prelabel, run: image.run?.id };
    if (before?.id !== image.id || isUnderWay(image)) return;
    if (before.prelabel === image.prelabel && before.run === image.run?.id) return;
    queryClient.invalidateQueries({ queryKey: annotationsKey(image.id) });
  }, [queryClient, image]);
}

/** A verdict taken back reopens an image; the server says so in its answer. */
function useStoredStatus(queryClient: QueryClient): void {
  useEffect(
    () =>
      onDecisionsStored((id, { status, verdicts }) =>
        queryClient.setQueryData(imageQuery(id).queryKey, (image) => image && { ...image, status, verdicts }),
      ),
    [queryClient],
  );
}

/** Once everything is sent, what was fetched of this image and of its dataset is out of date. */
async function forgetLater(queryClient: QueryClient, slug: string, imageId: number): Promise<void> {
  await outbox.flush().catch(() => undefined);
  queryClient.removeQueries({
    queryKey: keys.image(imageId),
    predicate: (query) => query.getObserversCount() === 0,
  });
  queryClient.invalidateQueries({ queryKey: keys.dataset(slug) });
}
