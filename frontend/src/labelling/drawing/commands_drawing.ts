/** Keys that draw lines by hand and change them. */

import type { Command } from "../../image_view/commands";

export interface DrawingActions {
  /** Takes the tool that traces a line between clicked points in hand, or lays it aside. */
  toggleTrace(): void;
  /** Takes the last clicked point back. */
  removePoint(): void;
  /** Cuts the line under the pointer there. */
  cutLine(): void;
  /** Takes the nearer end of the line under the pointer off, up to there. */
  trimLine(): void;
  /** Makes one of the two selected lines. */
  joinLines(): void;
  /** Follows the edge of the selected line beyond both ends. */
  extendLine(): void;
}

export const DRAWING_COMMANDS: readonly Command<DrawingActions>[] = [
  { id: "trace", keys: ["L"], label: "Trace a missing line", group: "Draw", run: (a) => a.toggleTrace() },
  {
    id: "remove-point",
    keys: ["Backspace"],
    label: "… take its last point back",
    group: "Draw",
    onImageOnly: true,
    repeats: true,
    run: (a) => a.removePoint(),
  },
  { id: "cut", keys: ["C"], label: "Cut the line at the pointer", group: "Draw", run: (a) => a.cutLine() },
  {
    id: "trim",
    keys: ["Shift+C"],
    label: "Trim its nearer end up to the pointer",
    group: "Draw",
    run: (a) => a.trimLine(),
  },
  { id: "join", keys: ["M"], label: "Join the two selected lines", group: "Draw", run: (a) => a.joinLines() },
  {
    id: "extend",
    keys: ["Shift+L"],
    label: "Extend the line along its edge",
    group: "Draw",
    run: (a) => a.extendLine(),
  },
];
