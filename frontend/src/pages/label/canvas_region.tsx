import { type RefObject, useLayoutEffect, useRef, useState } from "react";
import type { ImageDetail } from "../../api/types";
import type { Point } from "../../canvas/geometry";
import type { CandidateLook } from "../../canvas/layers/candidate_layer";
import type { Hit, Scene } from "../../canvas/scene";
import { CanvasView } from "../../canvas/view";
import { isBent, isShown, type LabelState, verdictAt } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import { HoverReadout } from "./hover_readout";

export interface PointerPlace {
  index: number;
  screen: Point;
}

interface CanvasRegionProps {
  image: ImageDetail;
  bitmap: ImageBitmap | null;
  scene: Scene | null;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  regionRef: RefObject<HTMLElement | null>;
  onScale: (scale: number) => void;
}

/**
 * The image with its candidates. Everything that moves is drawn by the canvas engine, not by React; what React
 * changes reaches it before the next frame, so that image and panel never belong to different images.
 */
export function CanvasRegion(props: CanvasRegionProps) {
  const { image, bitmap, scene, store, viewRef, regionRef, onScale } = props;
  const { id, width, height } = image;
  const imageCanvas = useRef<HTMLCanvasElement>(null);
  const candidateCanvas = useRef<HTMLCanvasElement>(null);
  const highlightCanvas = useRef<HTMLCanvasElement>(null);
  const storeRef = useRef(store);
  const [pointer, setPointer] = useState<PointerPlace | null>(null);
  const [paintedId, setPaintedId] = useState<number | null>(null);
  const openedId = useRef(id);
  storeRef.current = store;

  useLayoutEffect(() => {
    const host = regionRef.current;
    const canvases = [imageCanvas.current, candidateCanvas.current, highlightCanvas.current] as const;
    const [imageLayer, candidates, highlights] = canvases;
    if (host === null || imageLayer === null || candidates === null || highlights === null) return;
    const view = new CanvasView(
      host,
      { image: imageLayer, candidates, highlights },
      {
        hover: (index, screen) => setPointer(index === null || screen === null ? null : { index, screen }),
        click: (hits, again) => selectHit(storeRef.current, hits, again),
        viewChanged: ({ scale }) => onScale(scale),
        painted: (complete) => setPaintedId(complete ? openedId.current : null),
      },
    );
    viewRef.current = view;
    return () => {
      view.dispose();
      viewRef.current = null;
    };
  }, [regionRef, viewRef, onScale]);

  useLayoutEffect(() => {
    openedId.current = id;
    viewRef.current?.open({ width, height });
  }, [viewRef, id, width, height]);

  useLayoutEffect(() => {
    viewRef.current?.setImage(bitmap);
  }, [viewRef, bitmap]);

  useLayoutEffect(() => {
    const view = viewRef.current;
    if (view === null || store === null || scene === null) return;
    view.setScene(scene);
    return drawStore(view, store);
  }, [viewRef, store, scene]);

  return (
    <section
      ref={regionRef}
      className="label-canvas"
      role="application"
      aria-label={`Image ${image.name} with candidates. Tab goes through them, Escape twice leaves.`}
      aria-describedby="label-selection"
      aria-busy={paintedId !== id}
      // biome-ignore lint/a11y/noNoninteractiveTabindex: the image is operated by keys, as an application region
      tabIndex={0}
    >
      <canvas ref={imageCanvas} />
      <canvas ref={candidateCanvas} />
      <canvas ref={highlightCanvas} />
      {store && pointer ? <HoverReadout store={store} pointer={pointer} /> : null}
    </section>
  );
}

/** Keeps the canvas in step with the store until the returned function is called. */
function drawStore(view: CanvasView, store: LabelStore): () => void {
  let drawn = store.getState();
  view.setLook(lookOf(drawn));
  view.setSelected(drawn.selected);
  if (drawn.selected !== null && drawn.followRequest > 0) view.show(drawn.selected);
  return store.subscribe(() => {
    const state = store.getState();
    if (state.shown !== drawn.shown) view.setLook(lookOf(state));
    else if (state.verdicts !== drawn.verdicts) view.setLook(lookOf(state), changedIndices(drawn, state));
    if (state.selected !== drawn.selected) view.setSelected(state.selected);
    if (state.followRequest !== drawn.followRequest && state.selected !== null) view.show(state.selected);
    drawn = state;
  });
}

function lookOf(state: LabelState): CandidateLook {
  return {
    verdict: (index) => verdictAt(state, index),
    bent: (index) => isBent(state, index),
    visible: (index) => isShown(state, index),
  };
}

function changedIndices(before: LabelState, after: LabelState): number[] {
  return after.sequence.filter((index) => before.verdicts[index] !== after.verdicts[index]);
}

/** Selects the nearest candidate; a further click at the same place goes through all that lie there. */
function selectHit(store: LabelStore | null, hits: readonly Hit[], again: boolean): void {
  if (store === null) return;
  const selected = hits.findIndex((hit) => hit.index === store.getState().selected);
  const place = again ? (selected + 1) % Math.max(hits.length, 1) : 0;
  store.select(hits[place]?.index ?? null);
}
