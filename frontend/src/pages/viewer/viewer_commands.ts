/** Everything the keyboard does in the viewer. */

import {
  type Command,
  IMAGE_PAGE_COMMANDS,
  type ImagePageActions,
  VIEW_COMMANDS,
  type ViewActions,
} from "../../image_view/commands";
import { keymapOf } from "../../image_view/keymap";
import { LAYER_NAMES, LAYERS, type Layer } from "./layers";

/** What commands act on; the page provides it. */
export interface ViewerActions extends ViewActions, ImagePageActions {
  stepError(direction: 1 | -1): void;
  leaveSelection(): void;
  toggleLayer(layer: Layer): void;
  hideLines(): void;
  nextPalette(): void;
  flip(): void;
  toggleSideBySide(): void;
  toggleDifferences(): void;
  sendToReview(): void;
  copyLink(): void;
}

export const VIEWER_COMMAND_GROUPS = ["Errors", "Layers", "Compare", "View", "Image"] as const;

export const VIEWER_COMMANDS: readonly Command<ViewerActions>[] = [
  {
    id: "next-error",
    keys: ["J"],
    label: "Next error",
    group: "Errors",
    repeats: true,
    run: (a) => a.stepError(1),
  },
  {
    id: "previous-error",
    keys: ["K"],
    label: "Previous error",
    group: "Errors",
    repeats: true,
    run: (a) => a.stepError(-1),
  },
  {
    id: "tab",
    keys: ["Tab"],
    label: "Next error, on the image",
    group: "Errors",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.stepError(1),
  },
  {
    id: "shift-tab",
    keys: ["Shift+Tab"],
    label: "Previous error, on the image",
    group: "Errors",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.stepError(-1),
  },
  { id: "review", keys: ["R"], label: "Send to review", group: "Errors", run: (a) => a.sendToReview() },
  { id: "link", keys: ["L"], label: "Copy a link to it", group: "Errors", run: (a) => a.copyLink() },
  {
    id: "leave",
    keys: ["Escape"],
    label: "Close; deselect; leave the image",
    group: "Errors",
    run: (a) => a.leaveSelection(),
  },
  ...LAYERS.map(
    (layer): Command<ViewerActions> => ({
      id: `layer-${layer}`,
      keys: [layerKey(layer)],
      label: LAYER_NAMES[layer].many,
      group: "Layers",
      run: (a) => a.toggleLayer(layer),
    }),
  ),
  { id: "hide-lines", keys: ["H"], label: "Hide all lines", group: "Layers", run: (a) => a.hideLines() },
  { id: "palette", keys: ["C"], label: "Other colours", group: "Layers", run: (a) => a.nextPalette() },
  { id: "flip", keys: ["B"], label: "Flip between A and B", group: "Compare", run: (a) => a.flip() },
  {
    id: "side-by-side",
    keys: ["S"],
    label: "Side by side",
    group: "Compare",
    run: (a) => a.toggleSideBySide(),
  },
  {
    id: "differences",
    keys: ["D"],
    label: "Highlight the differences",
    group: "Compare",
    run: (a) => a.toggleDifferences(),
  },
  ...VIEW_COMMANDS,
  ...IMAGE_PAGE_COMMANDS,
];

export const VIEWER_KEYMAP = keymapOf(VIEWER_COMMANDS);

/** The key that shows or hides a layer: its place in the list, from 1 on. */
export function layerKey(layer: Layer): string {
  return String(LAYERS.indexOf(layer) + 1);
}
