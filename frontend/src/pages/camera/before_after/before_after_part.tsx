import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useRef, useState } from "react";
import { useNavigate } from "react-router";
import { calibrationImagesQuery, imageLinesQuery, undistortedUrl } from "../../../api/camera_endpoints";
import type { CalibrationImage, ImageLine } from "../../../api/camera_types";
import { displayUrl } from "../../../api/endpoints";
import type { Point } from "../../../canvas/geometry";
import { EMPTY_SCENE } from "../../../canvas/scene";
import { EmptyState, ErrorState } from "../../../design/states";
import { HoverReadout } from "../../../image_view/hover_readout";
import { keymapOf } from "../../../image_view/keymap";
import { imageLoader, useImageBitmap } from "../../../image_view/use_image_bitmap";
import { useKeys } from "../../../image_view/use_keys";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { segmentAddress } from "../segment_address";
import { useCameraAddress } from "../use_camera_address";
import { BEFORE_AFTER_COMMANDS, type BeforeAfterActions } from "./before_after_commands";
import { BeforeAfterTools } from "./before_after_tools";
import { ImageChooser } from "./image_chooser";
import { lineScenes } from "./line_scenes";
import { residualScale } from "./residual_colours";
import { SplitCanvas } from "./split_canvas";
import type { Side, SplitView } from "./split_view";
import "../../../image_view/image_view.css";
import "./before_after.css";

const KEYMAP = keymapOf(BEFORE_AFTER_COMMANDS);
const NO_LINES: readonly ImageLine[] = [];

/** The images of the camera as measured and with the lens taken out. */
export function BeforeAfterPart(props: PartProps) {
  const images = useQuery(calibrationImagesQuery(props.calibration.id));
  if (images.isError) return <ErrorState error={images.error} onRetry={() => images.refetch()} />;
  if (!images.data) {
    return (
      <div className="skeleton camera-page__loading-view" role="status" aria-label="Loading the images" />
    );
  }
  const there = images.data.filter(({ is_there }) => is_there);
  if (there.length === 0) {
    return (
      <EmptyState icon="images" title="The images are gone">
        The calibration stays, but the images that it was made from aren't in the dataset any more.
      </EmptyState>
    );
  }
  return <BeforeAfter {...props} images={there} />;
}

function BeforeAfter({ camera, calibration, images }: PartProps & { images: readonly CalibrationImage[] }) {
  const address = useCameraAddress();
  const navigate = useNavigate();
  const place = Math.max(
    0,
    images.findIndex(({ image_id }) => image_id === address.image),
  );
  const image = images[place] as CalibrationImage;
  const [share, setShare] = useState(0.5);
  const [ruler, setRuler] = useState(true);
  const [shown, setShown] = useState(true);
  const [scale, setScale] = useState(1);
  const [hovered, setHovered] = useState<{ index: number; screen: Point } | null>(null);
  const view = useRef<SplitView | null>(null);

  const measured = useImageBitmap(displayUrl(image.image_id), camera);
  const undistorted = useImageBitmap(undistortedUrl(calibration.id, image.image_id), camera);
  const answer = useQuery(imageLinesQuery(calibration.id, image.image_id));
  const lines = answer.data?.lines ?? NO_LINES;
  const scenes = useMemo(() => (lines.length === 0 ? null : lineScenes(lines)), [lines]);
  const residuals = useMemo(() => residualScale(calibration.result.noise), [calibration.result.noise]);
  const colours = useMemo(() => lines.map(({ rms }) => residuals.colourOf(rms ?? 0)), [lines, residuals]);
  const before = useSide(measured.bitmap, scenes?.before ?? EMPTY_SCENE);
  const after = useSide(undistorted.bitmap, scenes?.after ?? EMPTY_SCENE);
  useNeighboursAhead(calibration.id, images, place, camera);

  const choose = (to: number) => {
    const next = images[Math.min(images.length - 1, Math.max(0, to))];
    if (next) address.set({ image: next.image_id });
  };
  const latest = useRef({ choose, place });
  latest.current = { choose, place };
  const actions = useMemo<BeforeAfterActions>(
    () => ({
      fit: () => view.current?.fit(),
      zoom: (direction) => view.current?.zoomStep(direction),
      pan: (dx, dy) => view.current?.panStep(dx, dy),
      goToImage: (direction) => latest.current.choose(latest.current.place + direction),
      toggleRuler: () => setRuler((old) => !old),
      toggleLines: () => setShown((old) => !old),
      moveEdge: setShare,
    }),
    [],
  );
  useKeys(KEYMAP, actions);
  const told = hovered === null ? undefined : lines[hovered.index];
  const problem = measured.error ?? undistorted.error;

  return (
    <section className="before-after" aria-label="Before and after">
      <BeforeAfterTools
        ruler={ruler}
        shown={shown}
        scale={scale}
        residuals={lines.length > 0 ? residuals : null}
        lines={answer.data ? lines.length : null}
        onRetry={answer.isError ? () => void answer.refetch() : null}
        actions={actions}
      />
      <SplitCanvas
        size={camera}
        imageKey={image.image_id}
        before={before}
        after={after}
        colours={colours}
        share={share}
        ruler={ruler}
        shown={shown}
        label={`${image.name}, before and after the lens is taken out`}
        viewRef={view}
        onShare={setShare}
        onViewport={(viewport) => setScale(viewport.scale)}
        onHover={(index, screen) => setHovered(index === null || screen === null ? null : { index, screen })}
        onClick={(index) => {
          const line = index === null ? undefined : lines[index];
          if (line) navigate(segmentAddress(camera.dataset.slug, image.image_id, line.segment_id));
        }}
      >
        {told && hovered ? (
          <HoverReadout screen={hovered.screen}>
            <span className="numeric">
              Line {told.segment_id}: {px(told.rms)} RMS · click to open it
            </span>
          </HoverReadout>
        ) : null}
        {problem ? (
          <div className="image-notices">
            <div className="notice-card">
              <ErrorState
                error={problem}
                onRetry={() => {
                  if (measured.error) measured.retry();
                  if (undistorted.error) undistorted.retry();
                }}
              />
            </div>
          </div>
        ) : before.picture === null || after.picture === null ? (
          <p className="split__loading" role="status">
            <span className="spinner" aria-hidden="true" />
            {before.picture === null ? "Loading the image" : "Taking the lens out"}
          </p>
        ) : null}
      </SplitCanvas>
      <p className="before-after__name">
        <strong>{image.name}</strong>{" "}
        <span className="muted numeric">
          {image.inliers === 0
            ? "No line of this image was used."
            : `${image.inliers} of ${image.segments} lines fit, residual ${px(image.rms)}.`}
        </span>
      </p>
      {images.length > 1 ? <ImageChooser images={images} current={place} onChoose={choose} /> : null}
    </section>
  );
}

function useSide(picture: ImageBitmap | null, lines: Side["lines"]): Side {
  return useMemo(() => ({ picture, lines }), [picture, lines]);
}

/** The next image is there before it is asked for, as measured and undistorted. */
function useNeighboursAhead(
  calibrationId: number,
  images: readonly CalibrationImage[],
  place: number,
  { width, height }: { width: number; height: number },
): void {
  useEffect(() => {
    const next = images[place + 1];
    if (!next) return;
    const timer = setTimeout(() => {
      void imageLoader.prefetch(displayUrl(next.image_id), { width, height });
      void imageLoader.prefetch(undistortedUrl(calibrationId, next.image_id), { width, height });
    }, AHEAD);
    return () => clearTimeout(timer);
  }, [calibrationId, images, place, width, height]);
}

/** Whoever goes through images fast doesn't have all of them undistorted (ms). */
const AHEAD = 600;
