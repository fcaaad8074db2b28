/** What the viewer shows and what is selected, and how that changes. */

import type { Palette } from "../../canvas/match_style";
import type { Side } from "./difference";
import type { ErrorOrder } from "./errors";
import type { Layer, ShownLayers } from "./layers";
import type { MatchedImage, MatchedLine } from "./matched_image";
import type { ViewerAddress } from "./viewer_address";

export interface ViewerState {
  /** The image that the selection belongs to. */
  readonly imageId: number;
  /** Names of the selected lines; a label is selected on both sides. */
  readonly selected: Readonly<Record<Side, string | null>>;
  readonly shown: ShownLayers;
  /** All lines are hidden for a look at the bare image. */
  readonly bare: boolean;
  readonly order: ErrorOrder;
  readonly palette: Palette;
  readonly other: number | null;
  readonly side: Side;
  readonly sideBySide: boolean;
  readonly differences: boolean;
  /** Rises whenever the view should go to the selected line. */
  readonly followRequest: number;
}

export type ViewerChange =
  | { type: "opened"; imageId: number; segment: string | null }
  | { type: "selected"; side: Side; line: MatchedLine | null; image: MatchedImage; follow: boolean }
  | { type: "layer"; layer: Layer }
  | { type: "bare" }
  | { type: "order"; order: ErrorOrder }
  | { type: "palette"; palette: Palette }
  | { type: "side"; side: Side }
  | { type: "sideBySide" }
  | { type: "differences" }
  | { type: "compared"; other: number | null };

export function startState(
  imageId: number,
  address: ViewerAddress,
  preferences: { order: ErrorOrder; palette: Palette },
): ViewerState {
  const { segment, side, other } = address;
  return {
    imageId,
    selected: selectionOf(segment, side),
    shown: address.shown,
    bare: false,
    order: address.order ?? preferences.order,
    palette: preferences.palette,
    other,
    side: other === null ? "a" : side,
    sideBySide: other !== null && address.sideBySide,
    differences: other !== null && address.differences,
    followRequest: segment === null ? 0 : 1,
  };
}

export function changeState(state: ViewerState, change: ViewerChange): ViewerState {
  switch (change.type) {
    case "opened":
      return opened(state, change.imageId, change.segment);
    case "selected":
      return select(state, change);
    case "layer":
      return {
        ...state,
        bare: false,
        shown: { ...state.shown, [change.layer]: !state.shown[change.layer] },
      };
    case "bare":
      return { ...state, bare: !state.bare };
    case "order":
      return { ...state, order: change.order };
    case "palette":
      return { ...state, palette: change.palette };
    case "side":
      return state.other === null ? state : { ...state, side: change.side };
    case "sideBySide":
      return state.other === null ? state : { ...state, sideBySide: !state.sideBySide };
    case "differences":
      return state.other === null ? state : { ...state, differences: !state.differences };
    case "compared":
      return compared(state, change.other);
  }
}

function opened(state: ViewerState, imageId: number, segment: string | null): ViewerState {
  if (imageId === state.imageId) return state;
  const selected = selectionOf(segment, state.side);
  return { ...state, imageId, selected, followRequest: segment === null ? 0 : state.followRequest + 1 };
}

type Selection = Extract<ViewerChange, { type: "selected" }>;

/** With a prediction the label that it comes closest to is selected on the other side: what happened to it there? */
function select(state: ViewerState, { side, line, image, follow }: Selection): ViewerState {
  const partner = line?.partner == null ? undefined : image.lines[line.partner];
  const label = line?.kind === "label" ? line : partner?.kind === "label" ? partner : null;
  const selected = { a: label?.name ?? null, b: label?.name ?? null, [side]: line?.name ?? null };
  return { ...state, side, selected, followRequest: state.followRequest + (follow ? 1 : 0) };
}

/** Another submission has other predictions; labels stay. */
function compared(state: ViewerState, other: number | null): ViewerState {
  const label = [state.selected.b, state.selected.a].find((name) => name?.startsWith("l")) ?? null;
  const selected = { ...state.selected, b: label };
  if (other !== null) return { ...state, other, selected };
  return { ...state, other, selected, side: "a", sideBySide: false, differences: false };
}

function selectionOf(segment: string | null, side: Side): Record<Side, string | null> {
  if (segment?.startsWith("l")) return { a: segment, b: segment };
  return { a: null, b: null, [side]: segment };
}
