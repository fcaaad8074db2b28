import { type ReactNode, type RefObject, useLayoutEffect, useRef } from "react";
import type { Point } from "../../../canvas/geometry";
import type { Size, Viewport } from "../../../canvas/viewport";
import { EdgeSlider } from "./edge_slider";
import { type Side, SplitView } from "./split_view";

interface SplitCanvasProps {
  size: Size;
  /** Another one opens another image. */
  imageKey: number;
  before: Side;
  after: Side;
  colours: readonly string[];
  share: number;
  ruler: boolean;
  shown: boolean;
  label: string;
  viewRef: RefObject<SplitView | null>;
  onShare: (share: number) => void;
  onViewport: (viewport: Viewport) => void;
  onHover: (index: number | null, screen: Point | null) => void;
  onClick: (index: number | null) => void;
  children?: ReactNode;
}

/** An image before and after, and the edge between them. What moves is drawn by the engine, not by React. */
export function SplitCanvas(props: SplitCanvasProps) {
  const { size, imageKey, before, after, colours, share, ruler, shown, label, viewRef, onShare, children } =
    props;
  const frame = useRef<HTMLDivElement>(null);
  const region = useRef<HTMLElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const latest = useRef(props);
  latest.current = props;

  useLayoutEffect(() => {
    if (region.current === null || canvas.current === null) return;
    const view = new SplitView(region.current, canvas.current, {
      viewChanged: (viewport) => latest.current.onViewport(viewport),
      hover: (index, screen) => latest.current.onHover(index, screen),
      click: (index) => latest.current.onClick(index),
    });
    viewRef.current = view;
    return () => {
      view.dispose();
      viewRef.current = null;
    };
  }, [viewRef]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: another image is opened even where its size is the same
  useLayoutEffect(() => {
    viewRef.current?.open({ width: size.width, height: size.height });
  }, [viewRef, imageKey, size.width, size.height]);

  useLayoutEffect(() => {
    viewRef.current?.set({ before, after, colours, share, ruler, shown });
  }, [viewRef, before, after, colours, share, ruler, shown]);

  return (
    <div ref={frame} className="split">
      <section
        ref={region}
        className="image-canvas split__canvas"
        role="application"
        aria-label={label}
        // biome-ignore lint/a11y/noNoninteractiveTabindex: the image is operated by keys, as an application region
        tabIndex={0}
      >
        <canvas ref={canvas} />
      </section>
      {share > 0.06 ? <span className="split__side split__side--before">Before</span> : null}
      {share < 0.94 ? <span className="split__side split__side--after">After</span> : null}
      <EdgeSlider share={share} region={frame} onMove={onShare} />
      {children}
    </div>
  );
}
