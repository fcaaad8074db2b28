import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useState } from "react";
import { useSearchParams } from "react-router";
import type { ImageDetail } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { ErrorState } from "../../design/states";
import { dismissToast, toast } from "../../design/toast";
import type { LabelStore } from "../../labelling/label_store";
import { outbox } from "../../labelling/outbox_start";
import { Announcer } from "./announcer";
import { CanvasRegion } from "./canvas_region";
import { KeyList } from "./key_list";
import { LeftHint, NoCandidates, ReviewBanner } from "./notices";
import { SidePanel } from "./side_panel";
import { StatusStrip } from "./status_strip";
import { useImageBitmap } from "./use_image_bitmap";
import { useFocusBackAfterClick, useKeys } from "./use_keys";
import { REJECTED_TOAST, useLabelActions } from "./use_label_actions";
import { annotationsKey, type LabelSession } from "./use_label_session";
import { useLabelState, useSaveState } from "./use_store";

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
  const [keyList, setKeyList] = useState(false);
  const [leftHint, setLeftHint] = useState(false);
  const { bitmap, error: bitmapError, retry } = useImageBitmap(image.id, image);
  const leaveImage = useCallback(() => panelRef.current?.focus(), []);
  const toggleKeyList = useCallback(() => setKeyList((shown) => !shown), []);
  const actions = useLabelActions({ slug, image, store, viewRef, leaveImage, toggleKeyList, setLeftHint });
  useKeys(actions, regionRef);
  useFocusBackAfterClick(regionRef);
  useFirstSelection(store);
  useRefusedDecisions(image.id);

  // biome-ignore lint/correctness/useExhaustiveDependencies: each image starts with the focus on it
  useEffect(() => {
    regionRef.current?.focus({ preventScroll: true });
    setLeftHint(false);
    return () => dismissToast(REJECTED_TOAST);
  }, [image.id]);

  const scene = annotations?.scene ?? null;
  const empty = store !== null && store.getState().candidates.length === 0;
  return (
    <div className="label-page">
      <a className="skip-link" href="#label-panel">
        Skip to the review panel
      </a>
      <div className="label-stage">
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
        <div className="label-notices">
          {bitmapError || session.error ? (
            <div className="notice-card">
              <ErrorState
                error={bitmapError ?? session.error}
                onRetry={bitmapError ? retry : session.retry}
              />
            </div>
          ) : empty ? (
            <div className="notice-card">
              <NoCandidates slug={slug} image={image} />
            </div>
          ) : null}
          {store ? (
            <Banners
              store={store}
              image={image}
              leftHint={leftHint}
              onReopen={() => actions.setReview("open")}
              onReject={actions.rejectUndecided}
              onClose={() => setLeftHint(false)}
            />
          ) : null}
        </div>
        {keyList ? <KeyList onClose={toggleKeyList} /> : null}
        <StatusStrip scale={scale} actions={actions} />
      </div>
      {store && scene ? (
        <SidePanel
          slug={slug}
          image={image}
          store={store}
          scene={scene}
          bitmap={bitmap}
          actions={actions}
          panelRef={panelRef}
        />
      ) : (
        <aside className="label-panel" aria-busy="true" />
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

/** Starts with the candidate that the address names, else with the first undecided one. */
function useFirstSelection(store: LabelStore | null): void {
  const [parameters] = useSearchParams();
  const wanted = parameters.get("segment");
  useEffect(() => {
    if (store === null || store.getState().selected !== null) return;
    const index = wanted === null ? null : store.indexOfSegment(Number(wanted));
    if (index !== null) store.select(index, { follow: true });
    else store.selectFirstUndecided();
  }, [store, wanted]);
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
