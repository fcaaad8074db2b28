/** The tool in hand, and the one whose drag is under way: that drag ends with the tool it began with. */

import type { Point } from "./geometry";
import type { DragTarget } from "./gestures";
import type { PointerTool } from "./pointer_tool";

interface HandParts {
  /** Where in the image a screen position is. */
  readonly imagePoint: (screen: Point) => Point;
  /** Another tool is to be seen; null: none. */
  readonly show: (tool: PointerTool | null) => void;
}

export class ToolHand {
  private readonly parts: HandParts;
  private tool: PointerTool | null = null;
  private dragging: PointerTool | null = null;

  constructor(parts: HandParts) {
    this.parts = parts;
  }

  /** Takes a tool in hand, or lays it aside; false where it is there already. */
  take(tool: PointerTool | null): boolean {
    if (tool === this.tool) return false;
    if (this.dragging === null) this.tool?.hover?.(null);
    this.tool = tool;
    this.show();
    return true;
  }

  /** What gets the drag that begins now; null where there is no tool. */
  begin(): DragTarget | null {
    const { tool } = this;
    if (tool === null) return null;
    const { imagePoint } = this.parts;
    this.dragging = tool;
    const going = () => this.dragging === tool;
    return {
      down: (screen, shift) => tool.down(imagePoint(screen), screen, shift),
      move: (screen) => {
        if (going()) tool.move(imagePoint(screen), screen);
      },
      up: (screen) => {
        if (!going()) return;
        this.dragging = null;
        tool.up(imagePoint(screen), screen);
        if (tool !== this.tool) tool.hover?.(null);
        this.show();
      },
      cancel: () => this.cancel(),
    };
  }

  /** Ends a drag as if it had never begun; false where there is none. */
  cancel(): boolean {
    const tool = this.dragging;
    this.dragging = null;
    tool?.cancel();
    this.show();
    return tool !== null;
  }

  /** The pointer is above the image without a button; false where that isn't for a tool. */
  hover(screen: Point | null): boolean {
    this.tool?.hover?.(screen === null ? null : this.parts.imagePoint(screen));
    return this.tool !== null;
  }

  private show(): void {
    this.parts.show(this.dragging ?? this.tool);
  }
}
