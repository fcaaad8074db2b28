import { type RefObject, useEffect, useSyncExternalStore } from "react";
import type { CanvasView } from "../../../canvas/view";
import { HELD_TOOLS } from "../../../labelling/commands_tools";
import type { ToolBoxState } from "../../../labelling/tools/tool_box";
import { toolBox } from "../../../labelling/tools/tools_start";

export function useToolBoxState(): ToolBoxState {
  return useSyncExternalStore(toolBox.subscribe, toolBox.getState);
}

/** Gives the tool in hand to the view, and lays a held one aside when its key is up. */
export function useToolBox(viewRef: RefObject<CanvasView | null>): void {
  useEffect(() => {
    const give = () => viewRef.current?.setTool(toolBox.tool);
    give();
    const stop = toolBox.subscribe(give);
    return () => {
      stop();
      viewRef.current?.setTool(null);
    };
  }, [viewRef]);

  useEffect(() => {
    function onKeyUp({ key, code }: KeyboardEvent): void {
      const { held } = toolBox.getState();
      const letter = held === null ? undefined : HELD_TOOLS[held];
      if (letter !== undefined && (key.toUpperCase() === letter || code === `Key${letter}`))
        toolBox.release();
    }
    // A key that comes up in another window isn't heard here.
    const onBlur = () => toolBox.release();
    window.addEventListener("keyup", onKeyUp);
    window.addEventListener("blur", onBlur);
    return () => {
      window.removeEventListener("keyup", onKeyUp);
      window.removeEventListener("blur", onBlur);
      toolBox.release();
    };
  }, []);
}
