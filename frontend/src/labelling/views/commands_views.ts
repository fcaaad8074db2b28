/** Keys that change how the image is shown. */

import type { Command } from "../../image_view/commands";
import type { ImageView } from "./image_look";

export interface ViewsActions {
  toggleView(view: ImageView): void;
  brighten(steps: 1 | -1): void;
  plainView(): void;
}

export const VIEWS_COMMANDS: readonly Command<ViewsActions>[] = [
  {
    id: "undistorted",
    keys: ["V"],
    label: "Without the lens's distortion",
    group: "View",
    run: (a) => a.toggleView("undistorted"),
  },
  {
    id: "clahe",
    keys: ["B"],
    label: "Contrast evened out (CLAHE)",
    group: "View",
    run: (a) => a.toggleView("clahe"),
  },
  { id: "darker", keys: [","], label: "Darker", group: "View", repeats: true, run: (a) => a.brighten(-1) },
  { id: "brighter", keys: ["."], label: "Brighter", group: "View", repeats: true, run: (a) => a.brighten(1) },
  {
    id: "plain-view",
    keys: ["Shift+B"],
    label: "The image as stored",
    group: "View",
    run: (a) => a.plainView(),
  },
];
