import { type RefObject, useCallback, useEffect, useLayoutEffect, useRef, useState } from "react";
import type { Point } from "../../canvas/geometry";
import type { CanvasView } from "../../canvas/view";
import type { Viewport } from "../../canvas/viewport";
import type { Side } from "./difference";
import { lineNamed } from "./matched_image";
import { Pane } from "./pane";
import { submissionName } from "./submission_name";
import type { Viewer } from "./use_viewer";

export interface PaneRefs {
  view: RefObject<CanvasView | null>;
  region: RefObject<HTMLElement | null>;
}

interface ViewerStageProps {
  viewer: Viewer;
  /** Of the first pane, which shows either submission, and of the second one beside it. */
  panes: readonly [PaneRefs, PaneRefs];
  onScale: (scale: number) => void;
}

/** The image: once, with either submission's lines, or twice beside each other. */
export function ViewerStage({ viewer, panes, onScale }: ViewerStageProps) {
  const { state, images, other } = viewer;
  const both = state.sideBySide && images.a !== undefined && images.b !== undefined;
  const sides: Side[] = both ? ["a", "b"] : [images[state.side] === undefined ? "a" : state.side];
  const [pointer, setPointer] = useState<{ pane: number; screen: Point } | null>(null);
  const linked = useRef(false);
  const [first, second] = panes;

  // After the panes have opened the image: what they do by themselves then isn't a movement of the other one.
  useLayoutEffect(() => {
    if (!both || first.view.current === null || second.view.current === null) return;
    second.view.current.mirror(first.view.current.current);
    linked.current = true;
    return () => {
      linked.current = false;
    };
  }, [both, first, second]);

  const { followRequest, side } = state;
  const { imageId, current, selected } = viewer;
  const line = current === undefined ? null : lineNamed(current, selected[side]);
  const index = line?.index ?? null;
  const activePane = both && side === "b" ? second : first;
  // biome-ignore lint/correctness/useExhaustiveDependencies: the view goes to a line when asked to, not when it is selected
  useEffect(() => {
    if (followRequest > 0 && index !== null) activePane.view.current?.show(index);
  }, [followRequest, imageId, current]);

  const moved = useCallback(
    (pane: number, viewport: Viewport) => {
      onScale(viewport.scale);
      if (linked.current) panes[pane === 0 ? 1 : 0]?.view.current?.mirror(viewport);
    },
    [panes, onScale],
  );

  return (
    <div className="viewer-panes" data-both={both}>
      {sides.map((paneSide, pane) => {
        const image = images[paneSide];
        const refs = panes[pane];
        if (image === undefined || refs === undefined) return null;
        const submission = paneSide === "a" ? viewer.submission : other;
        return (
          <Pane
            // biome-ignore lint/suspicious/noArrayIndexKey: a pane keeps its view while it flips between submissions
            key={pane}
            imageId={imageId}
            image={image}
            bitmap={viewer.bitmap.bitmap}
            title={
              state.other === null || submission === null
                ? null
                : `${paneSide.toUpperCase()}: ${submissionName(submission)}`
            }
            active={both && paneSide === side}
            shown={state.shown}
            bare={state.bare}
            palette={state.palette}
            differing={state.differences ? (viewer.difference?.lines[paneSide] ?? null) : null}
            selected={selected[paneSide]}
            ghost={both && pointer !== null && pointer.pane !== pane ? pointer.screen : null}
            viewRef={refs.view}
            regionRef={refs.region}
            onPointer={(screen) => both && setPointer(screen === null ? null : { pane, screen })}
            onSelect={(found) =>
              viewer.dispatch({ type: "selected", side: paneSide, line: found, image, follow: false })
            }
            onViewport={(viewport) => moved(pane, viewport)}
          />
        );
      })}
    </div>
  );
}
