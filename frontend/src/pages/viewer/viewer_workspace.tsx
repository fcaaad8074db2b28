import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { Link } from "react-router";
import type { Submission } from "../../api/board_types";
import type { CanvasView } from "../../canvas/view";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { ErrorState } from "../../design/states";
import { KeyList } from "../../image_view/key_list";
import { LoadingNotice } from "../../image_view/loading_notice";
import { shortName } from "../../image_view/short_name";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { describeLine } from "./match_text";
import { submissionName } from "./submission_name";
import { useReview } from "./use_review";
import { useViewer, type Viewer } from "./use_viewer";
import { useViewerActions } from "./use_viewer_actions";
import { submissionPath } from "./viewer_address";
import { VIEWER_COMMAND_GROUPS, VIEWER_COMMANDS, VIEWER_KEYMAP } from "./viewer_commands";
import { ViewerNotice } from "./viewer_notices";
import { ViewerPanel } from "./viewer_panel";
import { type PaneRefs, ViewerStage } from "./viewer_stage";

const HINTS: readonly KeyHint[] = [
  ["J", "next error"],
  ["K", "previous"],
  ["1–5", "layers"],
  ["H", "hide lines"],
  ["N", "next image"],
];
const COMPARE_HINTS: readonly KeyHint[] = [...HINTS, ["B", "flip A and B"]];

interface ViewerWorkspaceProps {
  submission: Submission;
  imageId: number;
}

export function ViewerWorkspace({ submission, imageId }: ViewerWorkspaceProps) {
  const viewer = useViewer(submission, imageId);
  const { state, images } = viewer;
  const panes = usePanes();
  const panelRef = useRef<HTMLElement | null>(null);
  const [scale, setScale] = useState(1);
  const [keyList, setKeyList] = useState(false);
  const [said, setSaid] = useState("");
  const review = useReview({
    submission: state.side === "b" && state.other !== null ? state.other : submission.id,
    imageId,
    image: viewer.current,
    line: viewer.line,
  });
  const toggleKeyList = useCallback(() => setKeyList((shown) => !shown), []);
  const active = state.sideBySide && state.side === "b" ? panes[1] : panes[0];
  const actions = useViewerActions({
    viewer,
    view: () => active.view.current ?? panes[0].view.current,
    panelRef,
    keyList: { shown: keyList, toggle: toggleKeyList },
    sendToReview: review.send,
    say: setSaid,
  });
  useKeys(VIEWER_KEYMAP, actions);
  useFocusBackAfterClick(active.region);

  useEffect(() => {
    // Where the keyboard is on one image it goes on on the other one.
    if (document.activeElement?.matches(".image-canvas"))
      active.region.current?.focus({ preventScroll: true });
  }, [active]);

  const ready = images.a !== undefined;
  // biome-ignore lint/correctness/useExhaustiveDependencies: each image starts with the focus on it
  useEffect(() => {
    if (ready) active.region.current?.focus({ preventScroll: true });
  }, [imageId, ready]);

  const { split } = submission;
  const name = images.a?.detail.name;
  return (
    <PageFrame
      scrolling={false}
      crumbs={[
        { label: "Leaderboards", to: "/splits" },
        { label: split.name, to: `/splits/${split.slug}` },
        { label: submissionName(submission), to: submissionPath(submission.id, viewer.list) },
        { label: name === undefined ? "Image" : shortName(name) },
      ]}
    >
      <div className="image-page viewer-page">
        <a className="skip-link" href="#viewer-panel">
          Skip to the scores
        </a>
        <div className="image-stage">
          <ViewerStage viewer={viewer} panes={panes} onScale={setScale} />
          <p id="viewer-selection" className="visually-hidden" aria-live="polite">
            {describeLine(viewer.line, viewer.place, viewer.errors.length)}
          </p>
          <p className="visually-hidden" aria-live="polite">
            {said}
          </p>
          <div className="image-notices">
            <Problems viewer={viewer} />
            {viewer.current === undefined ? null : <ViewerNotice image={viewer.current} bare={state.bare} />}
          </div>
          {keyList ? (
            <KeyList commands={VIEWER_COMMANDS} groups={VIEWER_COMMAND_GROUPS} onClose={toggleKeyList} />
          ) : null}
          <StatusStrip hints={state.other === null ? HINTS : COMPARE_HINTS} scale={scale} actions={actions} />
        </div>
        <ViewerPanel viewer={viewer} actions={actions} review={review.state} panelRef={panelRef} />
      </div>
    </PageFrame>
  );
}

/** What can't be shown, or is still on its way. */
function Problems({ viewer }: { viewer: Viewer }) {
  const { submission, state, images, failures, bitmap, retry, dispatch } = viewer;
  const problem = failures.a ?? bitmap.error;
  if (problem) {
    return (
      <div className="notice-card">
        <ErrorState
          error={problem}
          onRetry={failures.a ? retry : bitmap.retry}
          actions={
            <Link className={buttonClass()} to={`/submissions/${submission.id}`}>
              To the submission
            </Link>
          }
        />
      </div>
    );
  }
  if (state.other !== null && failures.b) {
    return (
      <div className="banner banner--wrapping" role="alert">
        <span className="viewer-notice">The other submission can't be shown on this image.</span>
        <button
          type="button"
          className={buttonClass("default", true)}
          onClick={() => dispatch({ type: "compared", other: null })}
        >
          Stop comparing
        </button>
      </div>
    );
  }
  return images.a === undefined || bitmap.bitmap === null ? <LoadingNotice /> : null;
}

/** The views and elements of two panes, the same ones as long as the page lives. */
function usePanes(): readonly [PaneRefs, PaneRefs] {
  const firstView = useRef<CanvasView | null>(null);
  const firstRegion = useRef<HTMLElement | null>(null);
  const secondView = useRef<CanvasView | null>(null);
  const secondRegion = useRef<HTMLElement | null>(null);
  return useMemo(
    () => [
      { view: firstView, region: firstRegion },
      { view: secondView, region: secondRegion },
    ],
    [],
  );
}
