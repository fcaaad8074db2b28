/** Keys that judge or select many candidates at once. */

import type { RejectReason, Verdict } from "../api/types";
import type { Command } from "../image_view/commands";
import { REASON_NAMES, REASONS } from "./reasons";
import type { ToolName } from "./tools/tool_box";

export interface ToolActions {
  /** Takes a tool in hand until its key is up again. */
  holdTool(name: ToolName): void;
  selectShown(): void;
  selectFamily(): void;
  judgeFamily(verdict: Verdict): void;
  /** Takes over verdicts of the same edges in the frames before and after. */
  takeOver(): void;
  rejectFor(reason: RejectReason): void;
  /** The same by a button: on rejected candidates it changes the reason, or takes it back. */
  chooseReason(reason: RejectReason): void;
  cycleFocus(): void;
}

/** Tools that a key holds; the tool is laid aside when the key is up again. */
export const HELD_TOOLS: Readonly<Partial<Record<ToolName, string>>> = {
  "keep-brush": "W",
  "reject-brush": "E",
  "turn-brush": "T",
  lasso: "Q",
};

const held = (name: ToolName) => (actions: ToolActions) => actions.holdTool(name);

export const TOOL_COMMANDS: readonly Command<ToolActions>[] = [
  {
    id: "keep-brush",
    keys: ["W"],
    label: "Hold and drag: keep what you touch",
    group: "Many",
    run: held("keep-brush"),
  },
  {
    id: "reject-brush",
    keys: ["E"],
    label: "Hold and drag: reject what you touch",
    group: "Many",
    run: held("reject-brush"),
  },
  {
    id: "turn-brush",
    keys: ["T"],
    label: "Hold and drag from wrong to wrong: turn what is as likely",
    group: "Many",
    run: held("turn-brush"),
  },
  {
    id: "lasso",
    keys: ["Q", "Shift+Q"],
    label: "Hold and draw around: select",
    group: "Many",
    run: held("lasso"),
  },
  {
    id: "select-shown",
    keys: ["Ctrl+A"],
    label: "Select all that is shown",
    group: "Many",
    run: (a) => a.selectShown(),
  },
  { id: "family", keys: ["G"], label: "Select the family", group: "Many", run: (a) => a.selectFamily() },
  ...(
    [
      ["keep", "K"],
      ["reject", "X"],
      ["ambiguous", "A"],
    ] as const
  ).map(
    ([verdict, key]): Command<ToolActions> => ({
      id: `${verdict}-family`,
      keys: [`Shift+${key}`],
      label: `… ${verdict} all of it`,
      group: "Many",
      run: (a) => a.judgeFamily(verdict),
    }),
  ),
  {
    id: "take-over",
    keys: ["Y"],
    label: "As in the frames beside",
    group: "Many",
    run: (a) => a.takeOver(),
  },
  ...REASONS.map(
    (reason, index): Command<ToolActions> => ({
      id: `reject-${reason}`,
      keys: [String(index + 1)],
      label: REASON_NAMES[reason],
      group: "Reject because",
      run: (a) => a.rejectFor(reason),
    }),
  ),
  {
    id: "focus",
    keys: ["Shift+H"],
    label: "The others: shown, faint, hidden",
    group: "View",
    run: (a) => a.cycleFocus(),
  },
];
