import { useCallback, useEffect, useRef, useState } from "react";
import type { ImageDetail } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { KEYMAP } from "../../labelling/commands";
import { dismissImageToasts } from "./actions/image_toasts";
import { useLabelActions } from "./actions/use_label_actions";
import { usePageFocus } from "./actions/use_page_focus";
import { type LatestEdit, useCarriedSelection } from "./drawing/use_carried_selection";
import { useDrawing } from "./drawing/use_drawing";
import { useEdits } from "./drawing/use_edits";
import { usePointerPlaces } from "./drawing/use_pointer_places";
import { useNotedActions } from "./hints/use_noted_actions";
import { useJudging } from "./people/judging";
import type { Lease } from "./people/use_lease";
import { useRefusedDecisions } from "./saving/use_refused_decisions";
import { useFirstSelection, useSegmentAddress } from "./selection/use_segment_address";
import { useHistory } from "./session/use_history";
import type { LabelSession } from "./session/use_label_session";
import { useSuggestions } from "./suggestions/use_suggestions";
import { useToolActions } from "./tools/use_tool_actions";
import { useToolBox } from "./tools/use_tool_box";
import { useTools } from "./tools/use_tools";
import { useOverlays } from "./use_overlays";
import { type KeptLook, useImageLook } from "./views/use_image_look";

export interface WorkspaceParts {
  slug: string;
  session: LabelSession;
  image: ImageDetail;
  lease: Lease;
  look: KeptLook;
}

export type Workspace = ReturnType<typeof useWorkspace>;

/** What the page's parts share: the view, how the image is seen, and all that keys and buttons do. */
export function useWorkspace({ slug, session, image, lease, look }: WorkspaceParts) {
  const { annotations, store } = session;
  const viewRef = useRef<CanvasView | null>(null);
  const regionRef = useRef<HTMLElement | null>(null);
  const panelRef = useRef<HTMLElement | null>(null);
  const focus = usePageFocus(regionRef, panelRef);
  const { shown, control } = useOverlays(image.id);
  const seen = useImageLook(image, annotations?.scene ?? null, look);
  const whenHistoryKnown = useHistory(image.id, store, lease.news);
  const judging = useJudging();
  const { judges } = judging;

  const [latestEdit] = useState<LatestEdit>(() => ({ edit: null }));
  const undoRef = useRef<(groupId: string) => void>(() => undefined);
  const undoEdit = useCallback((groupId: string) => undoRef.current(groupId), []);
  const edits = useEdits(image.id, latestEdit, undoEdit);
  const pointer = usePointerPlaces(regionRef, viewRef);
  const plain = seen.shown !== "undistorted";
  const drawing = useDrawing({ judges, image, store, viewRef, pointer, edits, plain });

  const tools = useToolActions(image, store);
  const suggestions = useSuggestions(image.id, store, viewRef, judges);
  useTools({ judges, store, viewRef });
  useToolBox(viewRef);

  const unnoted = useLabelActions({
    judging,
    slug,
    image,
    store,
    viewRef,
    focus,
    overlays: control,
    views: seen.actions,
    tools,
    suggestions: suggestions.actions,
    drawing: drawing.actions,
    session: drawing.session,
    replayedEdit: edits.replayed,
    whenHistoryKnown,
  });
  const actions = useNotedActions(unnoted);
  // Only this edit is meant: whatever was done since has to be undone first, by its own key.
  undoRef.current = (groupId) =>
    whenHistoryKnown(() => {
      if (store?.getState().history.done.at(-1)?.id === groupId) actions.undo();
    });
  useKeys(KEYMAP, actions);
  useFocusBackAfterClick(regionRef);
  const settled = useCarriedSelection(image.id, store, latestEdit);
  useFirstSelection(store, settled);
  useSegmentAddress(store);
  useRefusedDecisions(image.id);

  // biome-ignore lint/correctness/useExhaustiveDependencies: each image starts with the focus on it
  useEffect(() => {
    focus.enterImage();
    return dismissImageToasts;
  }, [image.id]);

  return { viewRef, regionRef, panelRef, focus, shown, control, seen, judges, drawing, suggestions, actions };
}
