import { type RefObject, useLayoutEffect, useState } from "react";
import type { ImageDetail } from "../../api/types";
import type { LineLook } from "../../canvas/layers/line_layer";
import type { Hit, Scene } from "../../canvas/scene";
import { CANDIDATE_STYLES, lineStyle, styleName } from "../../canvas/style";
import type { CanvasView } from "../../canvas/view";
import { ImageCanvas, type PointerPlace } from "../../image_view/image_canvas";
import { isBent, isShown, type LabelState, verdictAt } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import { CandidateReadout } from "./candidate_readout";

interface CanvasRegionProps {
  image: ImageDetail;
  bitmap: ImageBitmap | null;
  scene: Scene | null;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  regionRef: RefObject<HTMLElement | null>;
  onScale: (scale: number) => void;
}

/** The image with its candidates. */
export function CanvasRegion(props: CanvasRegionProps) {
  const { image, bitmap, scene, store, viewRef, regionRef, onScale } = props;
  const [pointer, setPointer] = useState<PointerPlace | null>(null);

  useLayoutEffect(() => {
    const view = viewRef.current;
    if (view === null || store === null || scene === null) return;
    return drawStore(view, store);
  }, [viewRef, store, scene]);

  return (
    <ImageCanvas
      imageKey={image.id}
      width={image.width}
      height={image.height}
      bitmap={bitmap}
      scene={store === null ? null : scene}
      viewRef={viewRef}
      regionRef={regionRef}
      className="label-canvas"
      label={`Image ${image.name} with candidates. Tab goes through them, Escape twice leaves.`}
      describedBy="label-selection"
      onHover={(place) => setPointer(place?.index == null ? null : place)}
      onClick={(hits, again) => selectHit(store, hits, again)}
      onViewport={({ scale }) => onScale(scale)}
    >
      {store && pointer ? <CandidateReadout store={store} pointer={pointer} /> : null}
    </ImageCanvas>
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

function lookOf(state: LabelState): LineLook {
  return {
    styles: CANDIDATE_STYLES,
    style: (index) => lineStyle(styleName(verdictAt(state, index), isBent(state, index))),
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
