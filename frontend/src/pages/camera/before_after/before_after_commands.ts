/** What keys do while an image is compared before and after. */

import { type Command, VIEW_COMMANDS, type ViewActions } from "../../../image_view/commands";

export interface BeforeAfterActions extends ViewActions {
  goToImage(direction: 1 | -1): void;
  toggleRuler(): void;
  toggleLines(): void;
  /** To a share of the image's place, 0 to 1. */
  moveEdge(to: number): void;
}

export const BEFORE_AFTER_COMMANDS: readonly Command<BeforeAfterActions>[] = [
  { id: "next-image", keys: ["N", "]"], label: "Next image", group: "Image", run: (a) => a.goToImage(1) },
  {
    id: "previous-image",
    keys: ["P", "["],
    label: "Previous image",
    group: "Image",
    run: (a) => a.goToImage(-1),
  },
  {
    id: "ruler",
    keys: ["G"],
    label: "Straight grid, on or off",
    group: "Image",
    run: (a) => a.toggleRuler(),
  },
  { id: "lines", keys: ["L"], label: "Lines, on or off", group: "Image", run: (a) => a.toggleLines() },
  { id: "before", keys: ["B"], label: "Before only", group: "Image", run: (a) => a.moveEdge(1) },
  { id: "after", keys: ["A"], label: "After only", group: "Image", run: (a) => a.moveEdge(0) },
  { id: "both", keys: ["H"], label: "Half and half", group: "Image", run: (a) => a.moveEdge(0.5) },
  ...VIEW_COMMANDS,
];
