import { useQuery } from "@tanstack/react-query";
import { useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import { displayUrl, getPoints } from "../../api/endpoints";
import { imageQuery, keys } from "../../api/queries";
import type { Difference } from "../../api/team_endpoints";
import { decodePolylines } from "../../canvas/decode";
import { makeScene, type Scene } from "../../canvas/scene";
import type { CanvasView } from "../../canvas/view";
import { ErrorState } from "../../design/states";
import { ImageCanvas } from "../../image_view/image_canvas";
import { KeyList } from "../../image_view/key_list";
import { LoadingNotice } from "../../image_view/loading_notice";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { useImageBitmap } from "../../image_view/use_image_bitmap";
import { useFocusBackAfterClick, useKeys } from "../../image_view/use_keys";
import { viewActions } from "../../image_view/view_actions";
import {
  DIFFERENCES_COMMAND_GROUPS,
  DIFFERENCES_COMMANDS,
  DIFFERENCES_KEYMAP,
  type DifferencesActions,
} from "./differences_commands";
import { differencesLook } from "./differences_look";
import { DifferencesPanel } from "./differences_panel";
import type { Differences } from "./use_differences";

const HINTS: readonly KeyHint[] = [
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
  ["Tab", "next"],
  ["Z", "undo"],
];

interface DifferencesWorkspaceProps {
  slug: string;
  differences: Differences;
  current: Difference;
}

export function DifferencesWorkspace({ slug, differences, current }: DifferencesWorkspaceProps) {
  const { state, decide, takeBack, step, stepImage } = differences;
  const viewRef = useRef<CanvasView | null>(null);
  const regionRef = useRef<HTMLElement | null>(null);
  const panelRef = useRef<HTMLElement | null>(null);
  const [scale, setScale] = useState(1);
  const [keyList, setKeyList] = useState(false);
  const toggleKeyList = useCallback(() => setKeyList((shown) => !shown), []);
  const image = useQuery(imageQuery(current.image_id));
  const size = { width: image.data?.width ?? 1, height: image.data?.height ?? 1 };
  const {
    bitmap,
    error: bitmapError,
    retry,
  } = useImageBitmap(image.data === undefined ? null : displayUrl(current.image_id), size);
  const points = useScene(current.image_id);
  const scene = points.scene;

  const actions = useMemo<DifferencesActions>(
    () => ({
      judge: (verdict) => (verdict === "undecided" ? takeBack("current") : decide(verdict)),
      step,
      undo: () => takeBack("latest"),
      leaveSelection: () => (keyList ? toggleKeyList() : panelRef.current?.focus()),
      goToImage: stepImage,
      toggleKeyList,
      ...viewActions(() => viewRef.current),
    }),
    [decide, step, takeBack, stepImage, keyList, toggleKeyList],
  );
  useKeys(DIFFERENCES_KEYMAP, actions);
  useFocusBackAfterClick(regionRef);

  const index = scene === null ? -1 : scene.polylines.ids.indexOf(current.segment_id);
  const ofImage = useMemo(
    () => state.differences.filter((difference) => difference.image_id === current.image_id),
    [state.differences, current.image_id],
  );
  const ready = image.data !== undefined;
  // biome-ignore lint/correctness/useExhaustiveDependencies: the canvas comes with the image, perhaps after the lines
  useLayoutEffect(() => {
    const view = viewRef.current;
    if (view === null || scene === null) return;
    view.setLook(differencesLook(scene, ofImage));
    view.setSelected(index < 0 ? null : index);
    if (index >= 0) view.show(index);
  }, [scene, ofImage, index, ready]);

  useEffect(() => {
    if (ready) regionRef.current?.focus({ preventScroll: true });
  }, [ready]);

  const problem = image.error ?? bitmapError ?? points.error;
  return (
    <div className="image-page">
      <a className="skip-link" href="#differences-panel">
        Skip to the differences
      </a>
      <div className="image-stage">
        {image.data === undefined ? null : (
          <ImageCanvas
            imageKey={current.image_id}
            width={size.width}
            height={size.height}
            bitmap={bitmap}
            scene={scene}
            viewRef={viewRef}
            regionRef={regionRef}
            label={`Image ${current.image} with its differences. Tab goes through them, Escape leaves.`}
            describedBy="difference-said"
            onHover={() => undefined}
            onClick={(hits) => {
              const hit = hits[0];
              if (scene === null || hit === undefined) return;
              const segment = scene.polylines.ids[hit.index];
              differences.choose(
                state.differences.findIndex(
                  (known) => known.segment_id === segment && known.image_id === current.image_id,
                ),
              );
            }}
            onViewport={({ scale }) => setScale(scale)}
          />
        )}
        <div className="image-notices">
          {problem ? (
            <div className="notice-card">
              <ErrorState error={problem} onRetry={bitmapError ? retry : points.retry} />
            </div>
          ) : bitmap === null || scene === null ? (
            <LoadingNotice />
          ) : null}
        </div>
        {keyList ? (
          <KeyList
            commands={DIFFERENCES_COMMANDS}
            groups={DIFFERENCES_COMMAND_GROUPS}
            onClose={toggleKeyList}
          />
        ) : null}
        <StatusStrip hints={HINTS} scale={scale} actions={actions} />
      </div>
      <DifferencesPanel
        slug={slug}
        differences={differences}
        current={current}
        actions={actions}
        panelRef={panelRef}
      />
    </div>
  );
}

function useScene(imageId: number): { scene: Scene | null; error: unknown; retry: () => void } {
  const { data, error, refetch } = useQuery({
    queryKey: [...keys.image(imageId), "points"],
    queryFn: async () => makeScene(decodePolylines(await getPoints(imageId))),
    staleTime: Number.POSITIVE_INFINITY,
  });
  return { scene: data ?? null, error, retry: () => refetch() };
}
