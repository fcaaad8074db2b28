/** Which tool has the drags on the image: one that a key holds, else the one chosen in the tool bar. */

import type { PointerTool } from "../../canvas/pointer_tool";

export type ToolName = "keep-brush" | "reject-brush" | "turn-brush" | "lasso" | "trace";

export interface ToolBoxState {
  /** Stays until another one is chosen; null: drags move the image. */
  readonly chosen: ToolName | null;
  /** In hand as long as its key is down. */
  readonly held: ToolName | null;
}

export class ToolBox {
  private readonly tools = new Map<ToolName, PointerTool>();
  private readonly listeners = new Set<() => void>();
  private state: ToolBoxState = { chosen: null, held: null };

  readonly getState = (): ToolBoxState => this.state;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  /** The tool in hand; null: none is. */
  get tool(): PointerTool | null {
    const name = this.state.held ?? this.state.chosen;
    return name === null ? null : (this.tools.get(name) ?? null);
  }

  /** Puts a tool into the box until the returned function is called. */
  add(name: ToolName, tool: PointerTool): () => void {
    this.tools.set(name, tool);
    this.set({});
    return () => {
      if (this.tools.get(name) !== tool) return;
      this.tools.delete(name);
      this.set({});
    };
  }

  choose(chosen: ToolName | null): void {
    this.set({ chosen });
  }

  /** Takes a tool in hand, or lays it aside where it is there already. */
  toggle(name: ToolName): void {
    this.choose(this.state.chosen === name ? null : name);
  }

  hold(held: ToolName): void {
    this.set({ held });
  }

  /** The key of a held tool is up again; without a name, whichever it was. */
  release(name: ToolName | null = this.state.held): void {
    if (name !== null && this.state.held === name) this.set({ held: null });
  }

  /** Lays everything aside; false where nothing was in hand. */
  layAside(): boolean {
    const { chosen, held } = this.state;
    if (chosen === null && held === null) return false;
    this.set({ chosen: null, held: null });
    return true;
  }

  private set(part: Partial<ToolBoxState>): void {
    this.state = { ...this.state, ...part };
    for (const listener of [...this.listeners]) listener();
  }
}
