import { type RefObject, useMemo, useRef } from "react";
import { useNavigate } from "react-router";
import { PALETTES } from "../../canvas/match_style";
import type { CanvasView } from "../../canvas/view";
import { toast } from "../../design/toast";
import { copyLink } from "../../image_view/copy_link";
import { viewActions } from "../../image_view/view_actions";
import { nextInSequence } from "../../labelling/order";
import type { Side } from "./difference";
import { LAYER_NAMES } from "./layers";
import type { Viewer } from "./use_viewer";
import { viewerPath } from "./viewer_address";
import type { ViewerActions } from "./viewer_commands";

interface ActionParts {
  viewer: Viewer;
  /** The view of the submission that is looked at. */
  view: () => CanvasView | null;
  panelRef: RefObject<HTMLElement | null>;
  keyList: { shown: boolean; toggle: () => void };
  sendToReview: () => void;
  /** Tells screen readers what a key did. */
  say: (text: string) => void;
}

/** What keys and buttons do. */
export function useViewerActions(parts: ActionParts): ViewerActions {
  const navigate = useNavigate();
  const latest = useRef(parts);
  latest.current = parts;
  return useMemo(() => {
    const now = () => latest.current;
    const needsOther = (): boolean => {
      if (now().viewer.state.other !== null) return true;
      toast({ key: "compare", message: "Choose a submission to compare with first" });
      return false;
    };
    return {
      stepError: (direction) => stepError(now(), direction),
      leaveSelection: () => leaveSelection(now()),
      toggleLayer: (layer) => {
        const { viewer, say } = now();
        const shown = viewer.state.bare || !viewer.state.shown[layer];
        viewer.dispatch({ type: "layer", layer });
        say(`${LAYER_NAMES[layer].many} ${shown ? "shown" : "hidden"}`);
      },
      hideLines: () => {
        const { viewer, say } = now();
        viewer.dispatch({ type: "bare" });
        say(viewer.state.bare ? "Lines shown" : "Lines hidden");
      },
      nextPalette: () => {
        const { state, dispatch } = now().viewer;
        const next = (PALETTES.indexOf(state.palette) + 1) % PALETTES.length;
        dispatch({ type: "palette", palette: PALETTES[next] ?? "paper" });
      },
      flip: () => {
        const { viewer, say } = now();
        if (!needsOther()) return;
        const side: Side = viewer.state.side === "a" ? "b" : "a";
        viewer.dispatch({ type: "side", side });
        say(`Submission ${side.toUpperCase()}`);
      },
      toggleSideBySide: () => {
        if (needsOther()) now().viewer.dispatch({ type: "sideBySide" });
      },
      toggleDifferences: () => {
        if (needsOther()) now().viewer.dispatch({ type: "differences" });
      },
      sendToReview: () => now().sendToReview(),
      copyLink: () => {
        const { submission, imageId, query, line } = now().viewer;
        const address = new URL(viewerPath(submission.id, imageId, query), window.location.href);
        copyLink(address.href, `Link to this ${line === null ? "image" : "line"} copied`);
      },
      goToImage: (direction) => {
        const { submission, images, carried } = now().viewer;
        const id = direction === 1 ? images.a?.detail.next : images.a?.detail.previous;
        if (id != null) navigate(viewerPath(submission.id, id, carried));
        else now().say(direction === 1 ? "This is the last image" : "This is the first image");
      },
      toggleKeyList: () => now().keyList.toggle(),
      ...viewActions(() => now().view()),
    };
  }, [navigate]);
}

/** Errors of layers that are hidden are passed over. */
function stepError({ viewer, say }: ActionParts, direction: 1 | -1): void {
  const { state, dispatch, current, errors, line } = viewer;
  if (current === undefined) return;
  const next = nextInSequence(errors, line?.index ?? null, direction, (index) => {
    const layer = current.lines[index]?.layer;
    return layer !== undefined && state.shown[layer];
  });
  const found = next === null ? undefined : current.lines[next];
  if (found === undefined) say(errors.length === 0 ? "There are no errors" : "No other error is shown");
  else dispatch({ type: "selected", side: state.side, line: found, image: current, follow: true });
}

function leaveSelection({ viewer, keyList, panelRef }: ActionParts): void {
  const { state, dispatch, current, line } = viewer;
  if (keyList.shown) keyList.toggle();
  else if (line !== null && current !== undefined) {
    dispatch({ type: "selected", side: state.side, line: null, image: current, follow: false });
  } else panelRef.current?.focus();
}
