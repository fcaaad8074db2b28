import { useQueryClient } from "@tanstack/react-query";
import { type RefObject, useMemo } from "react";
import { useNavigate } from "react-router";
import type { EditKind, ImageDetail } from "../../../api/types";
import type { CanvasView } from "../../../canvas/view";
import { viewActions } from "../../../image_view/view_actions";
import type { ToolActions } from "../../../labelling/commands_tools";
import type { DrawingActions } from "../../../labelling/drawing/commands_drawing";
import type { TraceSession } from "../../../labelling/drawing/trace_session";
import type { ChangeGroup } from "../../../labelling/history";
import type { LabelStore } from "../../../labelling/label_store";
import type { SuggestionActions } from "../../../labelling/suggestions/commands_suggestions";
import { toolBox } from "../../../labelling/tools/tools_start";
import type { ViewsActions } from "../../../labelling/views/commands_views";
import type { Judging } from "../people/judging";
import { LOOKING_ONLY } from "../people/looking_only";
import { imageActions } from "./image_actions";
import { lookingActions } from "./looking_actions";
import type { OverlayControl, PageActions } from "./page_actions";
import type { PageFocus } from "./use_page_focus";
import { verdictActions } from "./verdict_actions";

interface ActionParts {
  judging: Judging;
  slug: string;
  image: ImageDetail;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  focus: PageFocus;
  overlays: OverlayControl;
  /** How the image is shown. */
  views: ViewsActions;
  /** For many candidates at once. */
  tools: ToolActions;
  suggestions: SuggestionActions;
  /** Lines by hand. */
  drawing: DrawingActions;
  /** The line that is being traced. */
  session: TraceSession;
  /** Shows an edit's lines again, or takes them away, if this group of decisions is one. */
  replayedEdit: (group: ChangeGroup) => EditKind | null;
  whenHistoryKnown: (act: () => void) => void;
}

/** What keys and buttons do, on this page's store, view and router. */
export function useLabelActions(parts: ActionParts): PageActions {
  const { judging, slug, image, store, viewRef, focus, overlays } = parts;
  const { views, tools, suggestions, drawing, session, replayedEdit, whenHistoryKnown } = parts;
  const navigate = useNavigate();
  const queryClient = useQueryClient();

  const ofVerdicts = useMemo(
    () => verdictActions({ store, overlays, replayedEdit, whenHistoryKnown }),
    [store, overlays, replayedEdit, whenHistoryKnown],
  );
  const ofImage = useMemo(
    () => imageActions({ slug, image, store, overlays, session, navigate, queryClient }),
    [slug, image, store, overlays, session, navigate, queryClient],
  );
  const ofPage = useMemo(() => {
    function leaveSelection(): void {
      if (viewRef.current?.cancelDrag() || toolBox.layAside()) return;
      // What had the focus may be gone with what is closed.
      if (overlays.close()) focus.enterImage();
      else if (store !== null && store.getState().selected !== null) store.select(null);
      else focus.leaveImage();
    }
    const { toggleKeyList, toggleStages, toggleJump, toggleGuidelines } = overlays;
    return {
      leaveSelection,
      stepJoin: focus.stepJoin,
      toggleKeyList,
      toggleStages,
      toggleJump,
      toggleGuidelines,
      ...viewActions(() => viewRef.current),
    };
  }, [store, viewRef, overlays, focus]);

  const { judges, why } = judging;
  return useMemo(() => {
    function finishAsSuggested(): void {
      const isTracing = session.getState().clicks.length > 0;
      if (!isTracing && store?.getState().verdicts.includes("undecided")) suggestions.acceptSuggestions();
      void ofImage.finish();
    }
    const actions: PageActions = {
      finishAsSuggested,
      ...ofPage,
      ...ofVerdicts,
      ...ofImage,
      ...views,
      ...suggestions,
      ...tools,
      ...drawing,
    };
    if (judges) return actions;
    return { ...actions, ...lookingActions(why ?? LOOKING_ONLY, () => actions.goToImage(1)) };
  }, [judges, why, store, session, ofPage, ofVerdicts, ofImage, views, suggestions, tools, drawing]);
}
