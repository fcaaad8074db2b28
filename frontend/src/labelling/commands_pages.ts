/** Keys that lead to other images, and to what the dataset's maintainer has written. */

import type { Command } from "../image_view/commands";

export interface PagesActions {
  toggleJump(): void;
  toggleGuidelines(): void;
}

export const PAGES_COMMANDS: readonly Command<PagesActions>[] = [
  {
    id: "jump",
    keys: ["/"],
    label: "Go to an image by its name",
    group: "Image",
    run: (a) => a.toggleJump(),
  },
  {
    id: "guidelines",
    keys: ["Shift+G"],
    label: "Guidelines of this dataset",
    group: "Image",
    run: (a) => a.toggleGuidelines(),
  },
];
