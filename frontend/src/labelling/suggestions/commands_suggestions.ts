/** Keys that accept, show and hide suggestions, and the one that changes the order of review. */

import type { Command } from "../../image_view/commands";

export interface SuggestionActions {
  acceptSuggestions(): void;
  toggleSuggestions(): void;
  nextOrder(): void;
}

export const SUGGESTION_COMMANDS: readonly Command<SuggestionActions>[] = [
  {
    id: "accept-suggestions",
    keys: ["S"],
    label: "Accept suggestions on screen",
    group: "Judge",
    run: (a) => a.acceptSuggestions(),
  },
  {
    id: "toggle-suggestions",
    keys: ["Shift+S"],
    label: "Show or hide suggestions",
    group: "View",
    run: (a) => a.toggleSuggestions(),
  },
  { id: "next-order", keys: ["O"], label: "Next order of review", group: "Move", run: (a) => a.nextOrder() },
];
