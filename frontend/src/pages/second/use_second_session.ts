import { queryOptions, useQuery } from "@tanstack/react-query";
import { useCallback, useEffect, useMemo, useRef } from "react";
import { getPoints } from "../../api/endpoints";
import {
  beginSecondReview,
  getSecondDecisions,
  getSecondSegments,
  type SecondReview,
  type SecondSegments,
} from "../../api/team_endpoints";
import type { SegmentFacts } from "../../api/types";
import { decodePolylines } from "../../canvas/decode";
import { makeScene, type Scene } from "../../canvas/scene";
import { selectPolylines } from "../../canvas/select_polylines";
import type { Size } from "../../canvas/viewport";
import type { Annotations } from "../../labelling/annotations";
import type { LabelStore } from "../../labelling/label_store";
import { openLabelStore } from "../../labelling/open_store";
import { readPreferences } from "../../labelling/preferences";
import { stopwatch } from "../../labelling/stopwatch_start";
import { secondOutbox } from "./second_outbox";

interface Loaded {
  review: SecondReview;
  annotations: Annotations;
}

export interface SecondSession {
  review: SecondReview | undefined;
  /** Of the image, px; not from the image's own address, which tells how many were kept. */
  size: Size | undefined;
  scene: Scene | null;
  store: LabelStore | null;
  /** Runs something once the history is known, or can't be had. */
  whenHistoryKnown: (act: () => void) => void;
  error: unknown;
  retry: () => void;
}

/** A second review as its person left it. Nothing that is asked for here tells of the first one. */
export function useSecondSession(imageId: number): SecondSession {
  const { data, error, refetch } = useQuery(secondQuery(imageId));
  const store = useMemo(() => (data === undefined ? null : openStore(data)), [data]);

  const known = useRef<Promise<unknown>>(Promise.resolve());
  useEffect(() => {
    if (data === undefined || store === null) return;
    // For undo across reloads; without it undo begins with this visit.
    known.current = getSecondDecisions(data.review.id)
      .then(({ decisions }) =>
        store.catchUp(
          decisions.map((decision) => ({ ...decision, person: null, reason: null, suggestion: null })),
          secondOutbox.pendingFor(data.review.id),
        ),
      )
      .catch(() => undefined);
  }, [data, store]);
  const whenHistoryKnown = useCallback((act: () => void) => void known.current.then(act), []);

  return {
    review: data?.review,
    size: data && { width: data.annotations.imageWidth, height: data.annotations.imageHeight },
    scene: data?.annotations.scene ?? null,
    store,
    whenHistoryKnown,
    error,
    retry: () => refetch(),
  };
}

const secondQuery = (imageId: number) =>
  queryOptions({
    queryKey: ["images", imageId, "second-review"],
    queryFn: async (): Promise<Loaded> => {
      const review = await beginSecondReview(imageId);
      await secondOutbox.ready;
      // What was decided here a moment ago is in the answer then.
      if (secondOutbox.pendingFor(review.id).length > 0) await secondOutbox.flush().catch(() => undefined);
      const [segments, polylines] = await Promise.all([
        getSecondSegments(review.id),
        getPoints(imageId).then(decodePolylines),
      ]);
      if (polylines.revision !== segments.revision) {
        throw new Error("The candidates have just changed; reload the page.");
      }
      // What a hand drew isn't judged a second time: it would tell what the first review kept.
      const judged = new Set(segments.segments.map(({ id }) => id));
      const scene = makeScene(selectPolylines(polylines, judged));
      return { review, annotations: annotationsOf(segments, scene) };
    },
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 0,
    retry: false,
  });

function annotationsOf(answer: SecondSegments, scene: Scene): Annotations {
  const facts = new Map(answer.segments.map((segment) => [segment.id, segment]));
  const candidates = Array.from(scene.polylines.ids, (id, ordinal) => {
    const found = facts.get(id);
    if (found === undefined) throw new Error("The candidates have just changed; reload the page.");
    return { ...found, ordinal, reason: null, origin: "pipeline" } as SegmentFacts;
  });
  return {
    imageId: answer.image_id,
    imageWidth: answer.width,
    imageHeight: answer.height,
    candidates,
    scene,
    lastDecisionId: 0,
  };
}

function openStore({ review, annotations }: Loaded): LabelStore {
  const { order, shown } = readPreferences(localStorage);
  return openLabelStore(annotations, {
    pending: secondOutbox.pendingFor(review.id),
    order,
    shown,
    stopwatch,
    newId: () => crypto.randomUUID(),
    record: (decisions) => secondOutbox.add(review.id, decisions),
  });
}
