import { type RefObject, useLayoutEffect, useMemo, useState } from "react";
import type { Point } from "../../canvas/geometry";
import type { LineLook } from "../../canvas/layers/line_layer";
import { MATCH_STYLES, type Palette } from "../../canvas/match_style";
import type { Hit } from "../../canvas/scene";
import type { CanvasView } from "../../canvas/view";
import type { Viewport } from "../../canvas/viewport";
import { HoverReadout } from "../../image_view/hover_readout";
import { ImageCanvas, type PointerPlace } from "../../image_view/image_canvas";
import { LineMark } from "../../image_view/line_mark";
import { errorTypeOf } from "../error_type_names";
import type { ShownLayers } from "./layers";
import { LAYER_NAMES } from "./layers";
import { degrees, lineTitle, pixels, ratio } from "./match_text";
import { lineNamed, type MatchedImage, type MatchedLine } from "./matched_image";

interface PaneProps {
  imageId: number;
  image: MatchedImage;
  bitmap: ImageBitmap | null;
  /** Which submission this is, where there are two. */
  title: string | null;
  active: boolean;
  shown: ShownLayers;
  bare: boolean;
  palette: Palette;
  /** The lines that tell of a difference; null where all count the same. */
  differing: ReadonlySet<number> | null;
  selected: string | null;
  /** Where the pointer is in the other pane. */
  ghost: Point | null;
  viewRef: RefObject<CanvasView | null>;
  regionRef: RefObject<HTMLElement | null>;
  onPointer: (screen: Point | null) => void;
  onSelect: (line: MatchedLine | null) => void;
  onViewport: (viewport: Viewport) => void;
}

/** One submission's lines on the image. */
export function Pane(props: PaneProps) {
  const { imageId, image, bitmap, title, active, palette, selected, ghost, viewRef, regionRef } = props;
  const { shown, bare, differing } = props;
  const { detail, scene, lines } = image;
  const [pointer, setPointer] = useState<PointerPlace | null>(null);

  const look = useMemo((): LineLook => {
    const { plain, faded, all } = MATCH_STYLES[palette];
    return {
      styles: all,
      style: (index) => {
        const layer = lines[index]?.layer ?? "ignored";
        return differing === null || differing.has(index) ? plain[layer] : faded[layer];
      },
      visible: (index) => !bare && shown[lines[index]?.layer ?? "ignored"],
    };
  }, [palette, lines, differing, bare, shown]);

  useLayoutEffect(() => {
    viewRef.current?.setLook(look);
  }, [viewRef, look]);

  useLayoutEffect(() => {
    const line = lineNamed(image, selected);
    viewRef.current?.setSelected(line?.index ?? null, line?.partner == null ? [] : [line.partner]);
  }, [viewRef, image, selected]);

  const select = (hits: readonly Hit[], again: boolean) => {
    const place = again
      ? (hits.findIndex((hit) => lines[hit.index]?.name === selected) + 1) % hits.length
      : 0;
    const hit = hits[place];
    props.onSelect(hit === undefined ? null : (lines[hit.index] ?? null));
  };
  const hovered = pointer?.index == null ? undefined : lines[pointer.index];

  return (
    <div className="viewer-pane" data-active={active}>
      <ImageCanvas
        imageKey={imageId}
        width={detail.width}
        height={detail.height}
        bitmap={bitmap}
        scene={scene}
        viewRef={viewRef}
        regionRef={regionRef}
        label={`Image ${detail.name}${title === null ? "" : `, ${title}`}, scored. J and K go through its errors, Escape twice leaves.`}
        describedBy="viewer-selection"
        onHover={(place) => {
          setPointer(place);
          props.onPointer(place?.screen ?? null);
        }}
        onClick={select}
        onViewport={props.onViewport}
      >
        {pointer && hovered ? (
          <HoverReadout screen={pointer.screen}>
            <LineReadout image={image} line={hovered} palette={palette} />
          </HoverReadout>
        ) : null}
        {ghost ? (
          <span
            className="ghost-pointer"
            aria-hidden="true"
            style={{ transform: `translate(${Math.round(ghost.x)}px, ${Math.round(ghost.y)}px)` }}
          />
        ) : null}
      </ImageCanvas>
      {title === null ? null : <p className="viewer-pane__title">{title}</p>}
    </div>
  );
}

interface LineReadoutProps {
  image: MatchedImage;
  line: MatchedLine;
  palette: Palette;
}

/** The line under the pointer, in a line. */
function LineReadout({ image, line, palette }: LineReadoutProps) {
  const { layer, length, liou, offset, angle, score, errorType, partner } = line;
  const other = partner === null ? undefined : image.lines[partner];
  return (
    <>
      <LineMark style={MATCH_STYLES[palette].plain[layer]} />
      <span>{errorTypeOf(errorType)?.name ?? LAYER_NAMES[layer].one.toLowerCase()}</span>
      <span className="numeric">{pixels(length, 0)}</span>
      {liou === null || other === undefined ? null : (
        <span className="numeric">
          LIoU {ratio(liou)} with {lineTitle(other).toLowerCase()}
        </span>
      )}
      {offset === null ? null : <span className="numeric">{pixels(offset)} off</span>}
      {angle === null ? null : <span className="numeric">{degrees(angle)}</span>}
      {score === null ? null : <span className="numeric">score {ratio(score)}</span>}
    </>
  );
}
