import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type Dispatch, type SetStateAction, useCallback, useEffect, useMemo, useState } from "react";
import { displayUrl, getPoints } from "../../../api/endpoints";
import { asProblem } from "../../../api/problem";
import { keys } from "../../../api/queries";
import type { ImageDetail } from "../../../api/types";
import { decodePolylines } from "../../../canvas/decode";
import { makeScene, type Scene } from "../../../canvas/scene";
import { toast } from "../../../design/toast";
import { useImageBitmap } from "../../../image_view/use_image_bitmap";
import type { ViewsActions } from "../../../labelling/views/commands_views";
import {
  describeStep,
  type ImageLook,
  type ImageView,
  PLAIN_LOOK,
  stepped,
  toggledView,
} from "../../../labelling/views/image_look";

const LOOK_TOAST = "image-look";
const LOOK_TOAST_DURATION = 1_500;

export interface ImageLookState {
  look: ImageLook;
  setLook: (look: ImageLook) => void;
  actions: ViewsActions;
  /** What is seen now: the plain image until the other view's pixels and lines are there. */
  shown: ImageView;
  /** The pixels of what is seen. */
  bitmap: ImageBitmap | null;
  /** The candidates as they lie in it. */
  scene: Scene | null;
  /** Of the plain image's pixels, without which nothing is seen. */
  error: unknown;
  retry: () => void;
}

/** Kept from image to image, since a dark sequence is dark all along. */
export type KeptLook = readonly [ImageLook, Dispatch<SetStateAction<ImageLook>>];

/** How the image is shown. */
export function useImageLook(
  image: ImageDetail,
  plainScene: Scene | null,
  [look, setLook]: KeptLook,
): ImageLookState {
  const latest = useLatestLook(look);
  const undistorted = look.view === "undistorted";
  const straight = useUndistortedScene(image, plainScene, undistorted);

  const plain = useImageBitmap(displayUrl(image.id), image);
  const other = useImageBitmap(look.view === "plain" ? null : displayUrl(image.id, look.view), image);

  const problem = look.view === "plain" ? null : (other.error ?? (undistorted ? straight.error : null));
  useEffect(() => {
    if (problem === null) return;
    const { message, hint } = asProblem(problem);
    toast({ key: LOOK_TOAST, tone: "danger", message: hint ? `${message}: ${hint}` : message });
    setLook((before) => ({ ...before, view: "plain" }));
  }, [problem, setLook]);

  const actions = useMemo<ViewsActions>(
    () => ({
      toggleView: (view) => setLook((before) => toggledView(before, view)),
      brighten: (steps) => {
        const next = stepped(latest(), "brightness", steps);
        setLook(next);
        toast({
          key: LOOK_TOAST,
          message: describeStep("brightness", next),
          duration: LOOK_TOAST_DURATION,
        });
      },
      plainView: () => setLook(PLAIN_LOOK),
    }),
    [latest, setLook],
  );

  const ready = other.bitmap !== null && (!undistorted || straight.scene !== null);
  const shown = ready ? look.view : "plain";
  return {
    look,
    setLook,
    actions,
    shown,
    bitmap: ready ? other.bitmap : plain.bitmap,
    scene: shown === "undistorted" ? straight.scene : plainScene,
    error: plain.error,
    retry: plain.retry,
  };
}

function useLatestLook(look: ImageLook): () => ImageLook {
  const [box] = useState(() => ({ look }));
  box.look = look;
  return useCallback(() => box.look, [box]);
}

interface UndistortedScene {
  scene: Scene | null;
  error: unknown;
}

/** Asked for again whenever the plain candidates are others: they are the same lines in the same order. */
function useUndistortedScene(image: ImageDetail, plain: Scene | null, wanted: boolean): UndistortedScene {
  const queryClient = useQueryClient();
  const revision = plain?.polylines.revision ?? null;
  const queryKey = useMemo(() => [...keys.image(image.id), "undistorted", revision], [image.id, revision]);
  const { data, error } = useQuery({
    queryKey,
    queryFn: async () => makeScene(decodePolylines(await getPoints(image.id, "undistorted"))),
    enabled: wanted && revision !== null,
    staleTime: Number.POSITIVE_INFINITY,
    retry: false,
  });
  useEffect(() => {
    // A refusal isn't kept: the lens may be known the next time somebody asks.
    if (!wanted && error) queryClient.removeQueries({ queryKey });
  }, [wanted, error, queryClient, queryKey]);
  const fits = data !== undefined && data.polylines.revision === revision;
  return { scene: wanted && fits ? data : null, error };
}
