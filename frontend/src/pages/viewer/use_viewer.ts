import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useReducer } from "react";
import { submissionQuery } from "../../api/board_queries";
import type { Submission } from "../../api/board_types";
import { ALL_BY_NAME, type ImageList } from "../../api/viewer_endpoints";
import { matchPalette } from "../../canvas/match_style";
import { getPalette, setPalette } from "../../design/palette";
import { useImageBitmap } from "../../image_view/use_image_bitmap";
import { differenceOf, type Side } from "./difference";
import { errorSequence } from "./errors";
import { lineNamed, type MatchedImage } from "./matched_image";
import { useMatchedImage, usePrefetchedNeighbours } from "./use_matched_image";
import { useViewerAddress } from "./use_viewer_address";
import { readAddress, writeAddress } from "./viewer_address";
import { readPreferences, writePreferences } from "./viewer_preferences";
import { changeState, startState, type ViewerState } from "./viewer_state";

const NOTHING_SELECTED = { a: null, b: null } as const;
const NO_SIZE = { width: 1, height: 1 } as const;

export type Viewer = ReturnType<typeof useViewer>;

/** All that the viewer knows: what is fetched, what is chosen, and what follows from both. */
export function useViewer(submission: Submission, imageId: number) {
  const [state, dispatch] = useReducer(changeState, imageId, (id) =>
    startState(id, readAddress(window.location.search), {
      ...readPreferences(localStorage),
      palette: matchPalette(getPalette()),
    }),
  );
  // The address of the images goes through history; what is chosen on one of them doesn't.
  const { sort, search } = readAddress(window.location.search);
  const list: ImageList = { sort, search };
  useEffect(() => {
    dispatch({ type: "opened", imageId, segment: readAddress(window.location.search).segment });
  }, [imageId]);
  const { order, palette } = state;
  useEffect(() => writePreferences(localStorage, { order }), [order]);
  useEffect(() => setPalette(palette === "safe" ? "safe" : "standard"), [palette]);

  const other = useQuery({ ...submissionQuery(state.other ?? 0), enabled: state.other !== null });
  const a = useMatchedImage(submission.id, imageId, list, true);
  const b = useMatchedImage(state.other, imageId, ALL_BY_NAME, state.other !== null);
  const images: Readonly<Record<Side, MatchedImage | undefined>> = { a: a.data, b: b.data };
  usePrefetchedNeighbours(submission.id, state.other, a.data, list);
  const bitmap = useImageBitmap(a.data?.detail.display ?? null, a.data?.detail ?? NO_SIZE);

  const current = images[state.side];
  const selected = state.imageId === imageId ? state.selected : NOTHING_SELECTED;
  const line = current === undefined ? null : lineNamed(current, selected[state.side]);
  const errors = useMemo(
    () => (current === undefined ? [] : errorSequence(current, order)),
    [current, order],
  );
  const difference = useMemo(
    () => (a.data !== undefined && b.data !== undefined ? differenceOf(a.data, b.data) : null),
    [a.data, b.data],
  );
  const query = queryOf(state, selected, list);
  useViewerAddress(query);

  return {
    state,
    dispatch,
    submission,
    imageId,
    other: other.data ?? null,
    images,
    failures: { a: a.error, b: b.error ?? other.error },
    retry: () => {
      a.refetch();
      if (state.other !== null) b.refetch();
    },
    list,
    bitmap,
    current,
    selected,
    line,
    errors,
    /** 1-based place of the selected line among the errors. */
    place: line === null ? null : errors.indexOf(line.index) + 1 || null,
    difference,
    /** What the address says of the present view. */
    query,
    /** What is taken along to another image. */
    carried: queryOf(state, NOTHING_SELECTED, list),
  };
}

function queryOf(state: ViewerState, selected: ViewerState["selected"], list: ImageList): string {
  const { shown, other, side, order, sideBySide, differences } = state;
  const segment = selected[side];
  return writeAddress({ ...list, other, shown, segment, side, order, sideBySide, differences });
}
