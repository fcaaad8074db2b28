import { type RefObject, useLayoutEffect, useState } from "react";
import type { ImageDetail } from "../../../api/types";
import type { Hit, Scene } from "../../../canvas/scene";
import type { CanvasView } from "../../../canvas/view";
import { firstPaint } from "../../../image_view/first_paint";
import { ImageCanvas, type PointerPlace } from "../../../image_view/image_canvas";
import type { LabelStore } from "../../../labelling/label_store";
import { preview } from "../../../labelling/tools/tools_start";
import { CandidateReadout } from "./candidate_readout";
import { drawStore } from "./draw_store";

interface CanvasRegionProps {
  image: Pick<ImageDetail, "id" | "name" | "width" | "height">;
  bitmap: ImageBitmap | null;
  scene: Scene | null;
  /** CSS filter of the image, lines left alone. */
  filter: string;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  regionRef: RefObject<HTMLElement | null>;
  onScale: (scale: number) => void;
}

/** The image with its candidates. */
export function CanvasRegion(props: CanvasRegionProps) {
  const { image, bitmap, scene, filter, store, viewRef, regionRef, onScale } = props;
  const [pointer, setPointer] = useState<PointerPlace | null>(null);

  useLayoutEffect(() => {
    const view = viewRef.current;
    if (view === null || store === null || scene === null) return;
    return drawStore(view, store, preview);
  }, [viewRef, store, scene]);

  return (
    <ImageCanvas
      imageKey={image.id}
      width={image.width}
      height={image.height}
      bitmap={bitmap}
      scene={store === null ? null : scene}
      filter={filter}
      viewRef={viewRef}
      regionRef={regionRef}
      className="label-canvas"
      label={`Image ${image.name} with candidates. Tab goes through them, Escape twice leaves.`}
      describedBy="label-selection"
      onHover={(place) => setPointer(place?.index == null ? null : place)}
      onClick={(hits, again, shift) => selectHit(store, hits, again, shift)}
      onViewport={({ scale }) => onScale(scale)}
      onPainted={() => firstPaint.painted(image.id)}
    >
      {store && pointer ? <CandidateReadout store={store} pointer={pointer} /> : null}
    </ImageCanvas>
  );
}

/**
 * Selects the nearest candidate; a further click at the same place goes through all that lie there, one with Shift adds
 * it to what is selected, or takes it away.
 */
function selectHit(store: LabelStore | null, hits: readonly Hit[], again: boolean, shift: boolean): void {
  if (store === null) return;
  const nearest = hits[0];
  if (shift) {
    if (nearest !== undefined) store.toggleSelected(nearest.index);
    return;
  }
  const selected = hits.findIndex((hit) => hit.index === store.getState().selected);
  const place = again ? (selected + 1) % Math.max(hits.length, 1) : 0;
  store.select(hits[place]?.index ?? null);
}
