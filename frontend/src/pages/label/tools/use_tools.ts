import { type RefObject, useEffect } from "react";
import type { Verdict } from "../../../api/types";
import { COLOURS } from "../../../canvas/palette";
import { LASSO } from "../../../canvas/style";
import type { CanvasView } from "../../../canvas/view";
import { getPalette } from "../../../design/palette";
import type { LabelStore } from "../../../labelling/label_store";
import { BrushTool } from "../../../labelling/tools/brush_tool";
import { LassoTool } from "../../../labelling/tools/lasso_tool";
import { givenToAll, turnedVerdicts } from "../../../labelling/tools/stroke_effects";
import { preview, toolBox } from "../../../labelling/tools/tools_start";
import { DONE, judgeEach } from "./judge_many";

interface ToolParts {
  /** Whether verdicts may be given at all. */
  judges: boolean;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
}

/** Puts the tools for an image's candidates into the tool box. */
export function useTools({ judges, store, viewRef }: ToolParts): void {
  useEffect(() => {
    if (store === null) return;
    const view = () => viewRef.current;
    const brush = (verdict: Verdict) =>
      new BrushTool({
        colour: () => COLOURS[getPalette()][verdict],
        view,
        preview,
        effect: givenToAll(verdict),
        judge: (verdicts) => judgeEach(store, verdicts, DONE[verdict]),
      });
    const turnBrush = new BrushTool({
      colour: () => LASSO.colour,
      view,
      preview,
      effect: (stroke) => turnedVerdicts(store.getState(), stroke),
      judge: (verdicts) => judgeEach(store, verdicts, "turned"),
    });
    const lasso = new LassoTool({
      view,
      preview,
      select: (indices, additional) =>
        store.selectAll(additional ? [...store.getState().selection, ...indices] : indices),
    });
    const stops = [toolBox.add("lasso", lasso)];
    if (judges) {
      stops.push(
        toolBox.add("keep-brush", brush("keep")),
        toolBox.add("reject-brush", brush("reject")),
        toolBox.add("turn-brush", turnBrush),
      );
    }
    return () => {
      viewRef.current?.cancelDrag();
      preview.clear();
      for (const stop of stops) stop();
    };
  }, [judges, store, viewRef]);
}
