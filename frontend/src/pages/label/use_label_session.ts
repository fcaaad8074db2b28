/** The data of the image under review, from the server and the outbox, and that of its neighbours. */

import { type QueryClient, queryOptions, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo } from "react";
import { displayUrl } from "../../api/endpoints";
import { imageQuery, keys } from "../../api/queries";
import type { ImageDetail } from "../../api/types";
import { type Annotations, loadAnnotations } from "../../labelling/annotations";
import type { LabelStore } from "../../labelling/label_store";
import { openLabelStore } from "../../labelling/open_store";
import { onDecisionsStored, outbox } from "../../labelling/outbox_start";
import { readPreferences } from "../../labelling/preferences";
import { stopwatch } from "../../labelling/stopwatch_start";
import { imageLoader } from "./use_image_bitmap";

const POLL = 1_500;

export const annotationsKey = (imageId: number) => [...keys.image(imageId), "annotations"] as const;

const annotationsQuery = (imageId: number) =>
  queryOptions({
    queryKey: annotationsKey(imageId),
    queryFn: async () => {
      await outbox.ready;
      // What was decided here a moment ago is in the answer then; without a network the fetch says so itself.
      if (outbox.pendingFor(imageId).length > 0) await outbox.flush().catch(() => undefined);
      return loadAnnotations(imageId);
    },
    // The store made of it is the truth from here on; fetching again would throw its selection away.
    staleTime: Number.POSITIVE_INFINITY,
  });

export interface LabelSession {
  image: ImageDetail | undefined;
  annotations: Annotations | undefined;
  store: LabelStore | null;
  error: unknown;
  retry: () => void;
}

export function useLabelSession(slug: string, imageId: number): LabelSession {
  const queryClient = useQueryClient();
  const image = useQuery({
    ...imageQuery(imageId),
    refetchInterval: ({ state }) => (isUnderWay(state.data) ? POLL : false),
  });
  const annotations = useQuery(annotationsQuery(imageId));
  const data = annotations.data;
  const store = useMemo(() => (data === undefined ? null : openStore(data)), [data]);

  useEffect(() => {
    if (image.data !== undefined) prefetchNeighbours(queryClient, image.data);
  }, [queryClient, image.data]);

  useReloadAfterRun(queryClient, image.data);
  useStoredStatus(queryClient);

  useEffect(
    () => () => {
      forgetLater(queryClient, slug, imageId);
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

function openStore(annotations: Annotations): LabelStore {
  const { order, shown } = readPreferences(localStorage);
  return openLabelStore(annotations, {
    pending: outbox.pendingFor(annotations.imageId),
    order,
    shown,
    stopwatch,
    newId: () => crypto.randomUUID(),
    record: (decisions) => outbox.add(annotations.imageId, decisions),
  });
}

function isUnderWay(image: ImageDetail | undefined): boolean {
  return image?.prelabel === "queued" || image?.prelabel === "running";
}

function prefetchNeighbours(queryClient: QueryClient, image: ImageDetail): void {
  const neighbours = new Set([image.next_open_id, image.next_id, image.previous_id]);
  neighbours.delete(image.id);
  for (const id of neighbours) {
    if (id === null) continue;
    prefetch(queryClient, id).catch(() => undefined);
  }
}

async function prefetch(queryClient: QueryClient, id: number): Promise<void> {
  queryClient.prefetchQuery(annotationsQuery(id));
  await imageLoader.load(displayUrl(id), await queryClient.fetchQuery(imageQuery(id)));
}

/** A run that finishes while the image is open brings candidates. */
function useReloadAfterRun(queryClient: QueryClient, image: ImageDetail | undefined): void {
  const underWay = isUnderWay(image);
  const id = image?.id;
  useEffect(() => {
    if (!underWay || id === undefined) return;
    return () => {
      queryClient.invalidateQueries({ queryKey: annotationsKey(id) });
    };
  }, [queryClient, underWay, id]);
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
