/** What a newcomer is told of, one thing at a time, until it has been used or waved away. */

import type { ToolName } from "../tools/tool_box";

export interface Hint {
  readonly id: HintId;
  /** Key caps. */
  readonly keys: readonly string[];
  /** Goes on after the keys. */
  readonly text: string;
  /** Judgements after which it is of use. */
  readonly after: number;
}

export type HintId =
  | "keys"
  | "brush"
  | "rest"
  | "suggestions"
  | "turn"
  | "trace"
  | "lasso"
  | "family"
  | "reason"
  | "focus"
  | "take-over";

/** From what helps most. */
export const HINTS: readonly Hint[] = [
  { id: "keys", keys: ["?"], text: "shows all keys", after: 2 },
  { id: "brush", keys: ["E"], text: "held while you drag rejects all that you touch; W keeps it", after: 6 },
  { id: "rest", keys: ["R"], text: "rejects all the rest once the straight lines are kept", after: 12 },
  { id: "suggestions", keys: ["S"], text: "accepts the suggestions on the screen", after: 16 },
  {
    id: "turn",
    keys: ["T"],
    text: "held while you drag from one wrong line to another turns both, and what is as likely between",
    after: 18,
  },
  { id: "trace", keys: ["L"], text: "and two clicks add a line that nobody found", after: 20 },
  {
    id: "lasso",
    keys: ["Q"],
    text: "held while you draw around lines selects them, for one verdict",
    after: 24,
  },
  { id: "family", keys: ["Shift", "X"], text: "rejects the whole family of a line", after: 32 },
  { id: "reason", keys: ["1"], text: "to 5 reject with a reason, such as a car or a shadow", after: 40 },
  { id: "focus", keys: ["Shift", "H"], text: "makes the other lines faint", after: 50 },
  { id: "take-over", keys: ["Y"], text: "takes over verdicts of the frames beside", after: 60 },
];

/** What taking a tool in hand shows to be known. */
export const HINT_OF_TOOL: Readonly<Record<ToolName, HintId>> = {
  "keep-brush": "brush",
  "reject-brush": "brush",
  "turn-brush": "turn",
  lasso: "lasso",
  trace: "trace",
};

/** What a person has done so far, on whatever image. */
export interface Experience {
  readonly judged: number;
  /** What was used, or waved away. */
  readonly known: readonly HintId[];
}

export const NEWCOMER: Experience = { judged: 0, known: [] };

/**
 * The hint to show, if there is one.
 *
 * @param possible Whether what it tells of could be done now.
 */
export function nextHint({ judged, known }: Experience, possible: (id: HintId) => boolean): Hint | null {
  return HINTS.find(({ id, after }) => judged >= after && !known.includes(id) && possible(id)) ?? null;
}
