import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useState } from "react";
import { displayUrl } from "../../api/endpoints";
import type { ImageDetail } from "../../api/types";
import { useRights } from "../../api/use_rights";
import type { CanvasView } from "../../canvas/view";
import { ErrorState } from "../../design/states";
import { dismissToast, toast } from "../../design/toast";
import { KeyList } from "../../image_view/key_list";
import { LoadingNotice } from "../../image_view/loading_notice";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { useImageBitmap } from "../../image_view/use_image_bitmap";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { COMMAND_GROUPS, COMMANDS, KEYMAP } from "../../labelling/commands";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import { Announcer } from "./announcer";
import { CanvasRegion } from "./canvas_region";
import { focusJoin } from "./join_list";
import { NoCandidates } from "./no_candidates";
import { LeftHint, ReviewBanner } from "./notices";
import { SidePanel } from "./side_panel";
import { useHistory } from "./use_history";
import { HISTORY_TOAST, REJECTED_TOAST, useLabelActions } from "./use_label_actions";
import { annotationsKey, type LabelSession } from "./use_label_session";
import { useOverlays } from "./use_overlays";
import { useFirstSelection, useSegmentAddress } from "./use_segment_address";
import { useLabelState, useSaveState } from "./use_store";

const HINTS: readonly KeyHint[] = [
  ["Tab", "next"],
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
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
}

export function LabelWorkspace({ slug, session, image }: LabelWorkspaceProps) {
  const { annotations, store } = session;
  const viewRef = useRef<CanvasView | null>(null);
  const regionRef = useRef<HTMLElement | null>(null);
  const panelRef = useRef<HTMLElement | null>(null);
  const [scale, setScale] = useState(1);
  const { shown, control } = useOverlays(image.id);
  const { bitmap, error: bitmapError, retry } = useImageBitmap(displayUrl(image.id), image);
  const leaveImage = useCallback(() => panelRef.current?.focus(), []);
  const enterImage = useCallback(() => regionRef.current?.focus({ preventScroll: true }), []);
  const stepJoin = useCallback((direction: 1 | -1) => focusJoin(panelRef.current, direction), []);
  const whenHistoryKnown = useHistory(image.id, store);
  const { label: judges } = useRights();
  const actions = useLabelActions({
    judges,
    slug,
    image,
    store,
    viewRef,
    leaveImage,
    enterImage,
    stepJoin,
    overlays: control,
    whenHistoryKnown,
  });
  useKeys(KEYMAP, actions);
  useFocusBackAfterClick(regionRef);
  useFirstSelection(store);
  useSegmentAddress(store);
  useRefusedDecisions(image.id);

  // biome-ignore lint/correctness/useExhaustiveDependencies: each image starts with the focus on it
  useEffect(() => {
    enterImage();
    return () => {
      dismissToast(REJECTED_TOAST);
      dismissToast(HISTORY_TOAST);
    };
  }, [image.id]);

  const scene = annotations?.scene ?? null;
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
          store={store}
          viewRef={viewRef}
          regionRef={regionRef}
          onScale={setScale}
        />
        {store ? <Announcer store={store} /> : null}
        <div className="image-notices">
          {problem ? (
            <div className="notice-card">
              <ErrorState error={problem} onRetry={bitmapError ? retry : session.retry} />
            </div>
          ) : bitmap === null || store === null ? (
            <LoadingNotice />
          ) : null}
          {empty && !problem ? <NoCandidates slug={slug} image={image} /> : null}
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
        </div>
        {shown.keyList ? (
          <KeyList commands={COMMANDS} groups={COMMAND_GROUPS} onClose={control.toggleKeyList} />
        ) : null}
        <StatusStrip hints={judges ? HINTS : LOOKING_HINTS} scale={scale} actions={actions} />
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
          stages={shown.stages}
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
