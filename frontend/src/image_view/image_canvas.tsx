import { type ReactNode, type RefObject, useLayoutEffect, useRef } from "react";
import type { Point } from "../canvas/geometry";
import type { Hit, Scene } from "../canvas/scene";
import { CanvasView } from "../canvas/view";
import type { Size, Viewport } from "../canvas/viewport";

/** Where on the canvas the pointer is, and the line under it. */
export interface PointerPlace {
  index: number | null;
  screen: Point;
}

interface ImageCanvasProps extends Size {
  /** Another one opens another image. */
  imageKey: number | string;
  bitmap: ImageBitmap | null;
  scene: Scene | null;
  viewRef: RefObject<CanvasView | null>;
  regionRef: RefObject<HTMLElement | null>;
  className?: string;
  /** CSS filter of the pixels, lines left alone. */
  filter?: string;
  /** Accessible name. */
  label: string;
  /** Id of the text that says what is selected. */
  describedBy: string;
  onHover: (place: PointerPlace | null) => void;
  /**
   * Hears of lines at the clicked place, nearest first; `again` where the click before was there too, `shift` where
   * the key was held.
   */
  onClick: (hits: readonly Hit[], again: boolean, shift: boolean) => void;
  onViewport: (viewport: Viewport) => void;
  /** Image and lines have been drawn. */
  onPainted?: (() => void) | undefined;
  children?: ReactNode;
}

/**
 * An image with lines. Everything that moves is drawn by the canvas engine, not by React; what React changes
 * reaches it before the next frame, so that image and panel never belong to different images.
 */
export function ImageCanvas(props: ImageCanvasProps) {
  const { imageKey, width, height, bitmap, scene, viewRef, regionRef, className, label, filter, children } =
    props;
  const imageCanvas = useRef<HTMLCanvasElement>(null);
  const lineCanvas = useRef<HTMLCanvasElement>(null);
  const latest = useRef(props);
  latest.current = props;

  useLayoutEffect(() => {
    const host = regionRef.current;
    const image = imageCanvas.current;
    const lines = lineCanvas.current;
    if (host === null || image === null || lines === null) return;
    const view = new CanvasView(
      host,
      { image, lines },
      {
        hover: (index, screen) => latest.current.onHover(screen === null ? null : { index, screen }),
        click: (hits, again, shift) => latest.current.onClick(hits, again, shift),
        viewChanged: (viewport) => latest.current.onViewport(viewport),
        painted: (complete) => {
          // Not by way of React: in the very frame in which it becomes true.
          host.ariaBusy = String(!complete);
          if (complete) latest.current.onPainted?.();
        },
      },
    );
    viewRef.current = view;
    return () => {
      view.dispose();
      viewRef.current = null;
    };
  }, [regionRef, viewRef]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: images of one size are opened too
  useLayoutEffect(() => {
    viewRef.current?.open({ width, height });
  }, [viewRef, imageKey, width, height]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: an opened image starts without pixels
  useLayoutEffect(() => {
    viewRef.current?.setImage(bitmap);
  }, [viewRef, bitmap, imageKey]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: an opened image starts without lines
  useLayoutEffect(() => {
    if (scene !== null) viewRef.current?.setScene(scene);
  }, [viewRef, scene, imageKey]);

  return (
    <section
      ref={regionRef}
      className={className === undefined ? "image-canvas" : `image-canvas ${className}`}
      role="application"
      aria-label={label}
      aria-describedby={props.describedBy}
      // As it begins; from then on the canvas engine says it.
      aria-busy={true}
      // biome-ignore lint/a11y/noNoninteractiveTabindex: the image is operated by keys, as an application region
      tabIndex={0}
    >
      <canvas ref={imageCanvas} style={filter === undefined ? undefined : { filter }} />
      <canvas ref={lineCanvas} />
      {children}
    </section>
  );
}
