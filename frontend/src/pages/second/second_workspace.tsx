import { useCallback, useEffect, useRef, useState } from "react";
import { displayUrl } from "../../api/endpoints";
import type { SecondReview } from "../../api/team_endpoints";
import type { ImageDetail } from "../../api/types";
import type { CanvasView } from "../../canvas/view";
import { ErrorState } from "../../design/states";
import { KeyList } from "../../image_view/key_list";
import { LoadingNotice } from "../../image_view/loading_notice";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { useImageBitmap } from "../../image_view/use_image_bitmap";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { CanvasRegion } from "../label/image/canvas_region";
import { Announcer } from "../label/selection/announcer";
import { SECOND_COMMAND_GROUPS, SECOND_COMMANDS, SECOND_KEYMAP } from "./second_commands";
import { SecondPanel } from "./second_panel";
import { useSecondActions } from "./use_second_actions";
import type { SecondSession } from "./use_second_session";

const HINTS: readonly KeyHint[] = [
  ["Tab", "next"],
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
  ["R", "reject the rest"],
  ["Enter", "done"],
];

interface SecondWorkspaceProps {
  slug: string;
  image: Pick<ImageDetail, "id" | "name" | "width" | "height">;
  review: SecondReview;
  session: SecondSession;
}

export function SecondWorkspace({ slug, image, review, session }: SecondWorkspaceProps) {
  const { scene, store, whenHistoryKnown } = session;
  const viewRef = useRef<CanvasView | null>(null);
  const regionRef = useRef<HTMLElement | null>(null);
  const panelRef = useRef<HTMLElement | null>(null);
  const [scale, setScale] = useState(1);
  const [keyList, setKeyList] = useState(false);
  const toggleKeyList = useCallback(() => setKeyList((shown) => !shown), []);
  const { bitmap, error, retry } = useImageBitmap(displayUrl(image.id), image);
  const actions = useSecondActions({
    slug,
    review,
    store,
    whenHistoryKnown,
    viewRef,
    panelRef,
    keyList,
    toggleKeyList,
  });
  useKeys(SECOND_KEYMAP, actions);
  useFocusBackAfterClick(regionRef);
  useEffect(() => {
    regionRef.current?.focus({ preventScroll: true });
    store?.selectFirstUndecided();
  }, [store]);
  return (
    <div className="image-page">
      <a className="skip-link" href="#second-panel">
        Skip to the review panel
      </a>
      <div className="image-stage">
        <CanvasRegion
          image={image}
          bitmap={bitmap}
          scene={scene}
          filter="none"
          store={store}
          viewRef={viewRef}
          regionRef={regionRef}
          onScale={setScale}
        />
        {store ? <Announcer store={store} /> : null}
        <div className="image-notices">
          {error ? (
            <div className="notice-card">
              <ErrorState error={error} onRetry={retry} />
            </div>
          ) : bitmap === null ? (
            <LoadingNotice />
          ) : null}
        </div>
        {keyList ? (
          <KeyList commands={SECOND_COMMANDS} groups={SECOND_COMMAND_GROUPS} onClose={toggleKeyList} />
        ) : null}
        <StatusStrip hints={HINTS} scale={scale} actions={actions} />
      </div>
      {store && scene ? (
        <SecondPanel
          review={review}
          store={store}
          scene={scene}
          bitmap={bitmap}
          actions={actions}
          panelRef={panelRef}
        />
      ) : (
        <aside className="image-panel" aria-busy="true" />
      )}
    </div>
  );
}
