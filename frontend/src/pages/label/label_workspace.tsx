import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useState } from "react";
import type { ImageDetail } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { ErrorState } from "../../design/states";
import { dismissToast, toast } from "../../design/toast";
import { KeyList } from "../../image_view/key_list";
import { LoadingNotice } from "../../image_view/loading_notice";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { COMMAND_GROUPS, COMMANDS, KEYMAP } from "../../labelling/commands";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import { cssFilter } from "../../labelling/views/image_look";
import { Announcer } from "./announcer";
import { CanvasRegion } from "./canvas_region";
import { DrawButtons } from "./drawing/draw_buttons";
import { TraceBanner } from "./drawing/trace_banner";
import { type LatestEdit, useCarriedSelection } from "./drawing/use_carried_selection";
import { useDrawing } from "./drawing/use_drawing";
import { EDIT_TOAST, useEdits } from "./drawing/use_edits";
import { usePointerPlaces } from "./drawing/use_pointer_places";
import { GuidelinesBox } from "./guidelines/guidelines_box";
import { HintTip } from "./hints/hint_tip";
import { useNotedActions } from "./hints/use_noted_actions";
import { focusJoin } from "./join_list";
import { JumpBox } from "./jump/jump_box";
import { NoCandidates } from "./no_candidates";
import { LeftHint, ReviewBanner } from "./notices";
import { useJudging } from "./people/judging";
import { LeaseBanner } from "./people/lease_banner";
import { StaleList } from "./people/stale_list";
import type { Lease } from "./people/use_lease";
import { RecallQuestion } from "./recall/recall_question";
import { SidePanel } from "./side_panel";
import { useSuggestions } from "./suggestions/use_suggestions";
import { MANY_TOAST } from "./tools/judge_many";
import { ToolBar } from "./tools/tool_bar";
import { useToolActions } from "./tools/use_tool_actions";
import { useToolBox } from "./tools/use_tool_box";
import { useTools } from "./tools/use_tools";
import { useHistory } from "./use_history";
import { HISTORY_TOAST, REJECTED_TOAST, useLabelActions } from "./use_label_actions";
import { annotationsKey, type LabelSession } from "./use_label_session";
import { useOverlays } from "./use_overlays";
import { useFirstSelection, useSegmentAddress } from "./use_segment_address";
import { useLabelState, useSaveState } from "./use_store";
import { useImageLook } from "./views/use_image_look";

const HINTS: readonly KeyHint[] = [
  ["Tab", "next"],
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
  ["S", "accept suggestions"],
  ["R", "reject the rest"],
  ["Enter", "done"],
];

const LOOKING_HINTS: readonly KeyHint[] = [
  ["Tab", "next line"],
  ["N", "next image"],
  ["P", "previous image"],
];

interface LabelWorkspaceProps {
  slug: string;
  session: LabelSession;
  image: ImageDetail;
  lease: Lease;
}

export function LabelWorkspace({ slug, session, image, lease }: LabelWorkspaceProps) {
  const { annotations, store } = session;
  const viewRef = useRef<CanvasView | null>(null);
  const regionRef = useRef<HTMLElement | null>(null);
  const panelRef = useRef<HTMLElement | null>(null);
  const [scale, setScale] = useState(1);
  const { shown, control } = useOverlays(image.id);
  const seen = useImageLook(image, annotations?.scene ?? null);
  const { bitmap, scene, error: bitmapError, retry } = seen;
  const leaveImage = useCallback(() => panelRef.current?.focus(), []);
  const enterImage = useCallback(() => regionRef.current?.focus({ preventScroll: true }), []);
  const stepJoin = useCallback((direction: 1 | -1) => focusJoin(panelRef.current, direction), []);
  const whenHistoryKnown = useHistory(image.id, store, lease.news);
  const { judges, why } = useJudging();
  const tools = useToolActions(image, store);
  const suggestions = useSuggestions(image.id, store, viewRef, judges);
  const [latestEdit] = useState<LatestEdit>(() => ({ edit: null }));
  const undoRef = useRef<(groupId: string) => void>(() => undefined);
  const undoEdit = useCallback((groupId: string) => undoRef.current(groupId), []);
  const edits = useEdits(image.id, latestEdit, undoEdit);
  const pointer = usePointerPlaces(regionRef, viewRef);
  const plain = seen.shown !== "undistorted";
  const drawing = useDrawing({ judges, image, store, viewRef, pointer, edits, plain });
  useTools({ judges, store, viewRef });
  useToolBox(viewRef);
  const unnoted = useLabelActions({
    judges,
    why,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
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
    enterImage();
    return () => {
      dismissToast(REJECTED_TOAST);
      dismissToast(HISTORY_TOAST);
      dismissToast(MANY_TOAST);
      dismissToast(EDIT_TOAST);
    };
  }, [image.id]);

  const closeJump = useCallback(() => {
    control.toggleJump();
    enterImage();
  }, [control, enterImage]);

  const problem = bitmapError ?? session.error;
  const empty = store !== null && store.getState().candidates.length === 0;
  return (
    <div className="image-page">
      <a className="skip-link" href="#label-panel">
        Skip to the review panel
      </a>
      <div className="image-stage">
        <CanvasRegion
          image={image}
          bitmap={bitmap}
          scene={scene}
          filter={cssFilter(seen.look)}
          store={store}
          viewRef={viewRef}
          regionRef={regionRef}
          onScale={setScale}
        />
        {store ? <Announcer store={store} /> : null}
        <ToolBar>{judges ? <DrawButtons tracing={drawing.tracing} actions={actions} /> : null}</ToolBar>
        <div className="image-notices">
          {problem ? (
            <div className="notice-card">
              <ErrorState error={problem} onRetry={bitmapError ? retry : session.retry} />
            </div>
          ) : bitmap === null || store === null ? (
            <LoadingNotice />
          ) : null}
          {empty && !problem ? <NoCandidates slug={slug} image={image} /> : null}
          {drawing.tracing ? <TraceBanner session={drawing.session} /> : null}
          {store ? (
            <Banners
              store={store}
              image={image}
              leftHint={shown.leftHint}
              onReopen={() => actions.setReview("open")}
              onReject={actions.rejectUndecided}
              onClose={() => control.setLeftHint(false)}
            />
          ) : null}
          {lease.holder ? <LeaseBanner holder={lease.holder} onTakeOver={lease.takeOver} /> : null}
          {store ? <StaleList imageId={image.id} store={store} /> : null}
          {shown.recall ? (
            <RecallQuestion onAnswer={actions.answerRecall} onClose={() => control.setRecall(false)} />
          ) : null}
        </div>
        {shown.jump ? <JumpBox slug={slug} onGo={actions.goTo} onClose={closeJump} /> : null}
        {shown.guidelines ? <GuidelinesBox slug={slug} onClose={control.toggleGuidelines} /> : null}
        {shown.keyList ? (
          <KeyList commands={COMMANDS} groups={COMMAND_GROUPS} onClose={control.toggleKeyList} />
        ) : null}
        <StatusStrip
          hints={judges ? HINTS : LOOKING_HINTS}
          tip={judges && store ? <HintTip image={image} store={store} /> : null}
          scale={scale}
          actions={actions}
        />
      </div>
      {store && scene ? (
        <SidePanel
          slug={slug}
          image={image}
          store={store}
          scene={scene}
          bitmap={bitmap}
          actions={actions}
          viewRef={viewRef}
          suggestions={suggestions}
          stages={shown.stages && seen.shown !== "undistorted"}
          look={seen.look}
          onLook={seen.setLook}
          discarding={shown.discarding && image.status !== "discarded"}
          panelRef={panelRef}
        />
      ) : (
        <aside className="image-panel" aria-busy="true" />
      )}
    </div>
  );
}

interface BannersProps {
  store: LabelStore;
  image: ImageDetail;
  leftHint: boolean;
  onReopen: () => void;
  onReject: () => void;
  onClose: () => void;
}

function Banners({ store, image, leftHint, onReopen, onReject, onClose }: BannersProps) {
  const { counts } = useLabelState(store);
  if (image.status !== "open") return <ReviewBanner image={image} kept={counts.keep} onReopen={onReopen} />;
  if (leftHint && counts.undecided > 0) {
    return <LeftHint undecided={counts.undecided} onReject={onReject} onClose={onClose} />;
  }
  return null;
}

/** A decision that the server refuses for good is said, and the server's state shown. */
function useRefusedDecisions(imageId: number): void {
  const queryClient = useQueryClient();
  const saving = useSaveState();
  useEffect(() => {
    if (saving.kind !== "refused") return;
    const message = saving.refused[0]?.problem.message ?? "The server refused a decision.";
    toast({ key: "refused", tone: "danger", message: `${message} The server's state is shown.` });
    queryClient.invalidateQueries({ queryKey: annotationsKey(imageId) });
    outbox.dismissRefused();
  }, [saving, queryClient, imageId]);
}
