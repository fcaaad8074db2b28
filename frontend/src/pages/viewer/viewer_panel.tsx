import type { RefObject } from "react";
import { overlayUrl } from "../../api/viewer_endpoints";
import { CompareSection } from "./compare_section";
import { ErrorsSection } from "./errors_section";
import { LayersSection } from "./layers_section";
import { LineSection, type ReviewState } from "./line_section";
import { ResultSection } from "./result_section";
import type { Viewer } from "./use_viewer";
import { viewerPath } from "./viewer_address";
import type { ViewerActions } from "./viewer_commands";

interface ViewerPanelProps {
  viewer: Viewer;
  actions: ViewerActions;
  review: ReviewState;
  panelRef: RefObject<HTMLElement | null>;
}

/** Everything beside the image. */
export function ViewerPanel({ viewer, actions, review, panelRef }: ViewerPanelProps) {
  const { state, dispatch, submission, other, images, current, line, errors, place, difference } = viewer;
  if (images.a === undefined || current === undefined) {
    return (
      <aside className="image-panel" aria-busy={viewer.failures.a === null} ref={panelRef} tabIndex={-1} />
    );
  }
  return (
    <aside className="image-panel" aria-label="Scores" ref={panelRef} tabIndex={-1} id="viewer-panel">
      <div className="image-panel__scroll">
        <LayersSection
          images={images.b === undefined ? [images.a] : [images.a, images.b]}
          shown={state.shown}
          bare={state.bare}
          palette={state.palette}
          onLayer={actions.toggleLayer}
          onPalette={(palette) => dispatch({ type: "palette", palette })}
        />
        <ErrorsSection
          total={errors.length}
          place={place}
          scored={current.lines.some(({ score }) => score !== null)}
          order={state.order}
          onStep={actions.stepError}
          onOrder={(order) => dispatch({ type: "order", order })}
        />
        <LineSection
          image={current}
          line={line}
          bitmap={viewer.bitmap.bitmap}
          palette={state.palette}
          review={review}
          onReview={actions.sendToReview}
          onPartner={(partner) =>
            dispatch({ type: "selected", side: state.side, line: partner, image: current, follow: true })
          }
          onCopyLink={actions.copyLink}
        />
        <CompareSection
          a={submission}
          b={other}
          other={state.other}
          side={state.side}
          sideBySide={state.sideBySide}
          differences={state.differences}
          difference={difference}
          onCompare={(id) => dispatch({ type: "compared", other: id })}
          onSide={(side) => dispatch({ type: "side", side })}
          onSideBySide={() => dispatch({ type: "sideBySide" })}
          onDifferences={() => dispatch({ type: "differences" })}
        />
        <ResultSection
          a={images.a}
          b={images.b ?? null}
          overlay={overlayUrl(submission.id, viewer.imageId)}
          pathTo={(id) => viewerPath(submission.id, id, viewer.carried)}
        />
      </div>
    </aside>
  );
}
