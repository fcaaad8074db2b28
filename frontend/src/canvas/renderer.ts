/**
 * Draws the image on one canvas and its lines on another, at most once per display frame.
 *
 * What changed decides what is drawn: a hover copies the lines' bitmap and draws its highlight on it, as a movement
 * does; a verdict redraws the bitmap along its line; the end of a movement has the bitmap drawn anew. A canvas of its
 * own for the highlights would be one more that each frame has to put on the screen, all of it.
 */

import { drawCompanions, drawHighlights } from "./layers/highlight_layer";
import { drawImageLayer } from "./layers/image_layer";
import { LineBitmap } from "./layers/line_bitmap";
import type { LineLook } from "./layers/line_layer";
import { drawStages } from "./layers/stage_layer";
import { makeSurface, resizeSurface, type Surface, setScreenUnits } from "./layers/surface";
import { linePainter } from "./line_painter_start";
import type { PointerTool } from "./pointer_tool";
import { EMPTY_SCENE, type Scene } from "./scene";
import type { StageTrace } from "./stage_trace";
import { lineStyle } from "./style";
import type { Size, Viewport } from "./viewport";

/** How long the view must rest before the lines are drawn exactly (ms). */
const REST = 90;
/** Beyond this many changed lines all are drawn anew. */
const MOST_REDRAWN = 24;

export interface RendererState {
  readonly image: CanvasImageSource | null;
  readonly imageSize: Size;
  readonly scene: Scene;
  readonly look: LineLook;
  readonly viewport: Viewport;
  readonly selected: number | null;
  readonly hovered: number | null;
  /** Lines that belong to the selected one. */
  readonly companions: readonly number[];
  /** How the selected candidate was found; null while nobody asks. */
  readonly stages: StageTrace | null;
  /** Which of its gaps is pointed at. */
  readonly markedGap: number | null;
  readonly tool: PointerTool | null;
}

/** The parts of the picture that a change touches. */
export type Change = "view" | "image" | "scene" | "lines" | "picture" | "highlights";

const START: RendererState = {
  image: null,
  imageSize: { width: 1, height: 1 },
  scene: EMPTY_SCENE,
  look: { styles: [lineStyle("undecided")], style: () => lineStyle("undecided"), visible: () => true },
  viewport: { scale: 1, offsetX: 0, offsetY: 0 },
  selected: null,
  hovered: null,
  companions: [],
  stages: null,
  markedGap: null,
  tool: null,
};

export class Renderer {
  private state: RendererState = START;
  private screen: Size = { width: 1, height: 1 };
  private ratio = 1;
  private frame: number | null = null;
  private restTimer: ReturnType<typeof setTimeout> | null = null;
  private readonly changed = new Set<Change>();
  private readonly changedLines = new Set<number>();
  private readonly bitmap: LineBitmap;
  private readonly imageSurface: Surface;
  private readonly lineSurface: Surface;
  private readonly onPainted: (complete: boolean) => void;
  private complete = false;

  /** @param onPainted Hears when an opened image and its lines are all drawn, and when they aren't any more. */
  constructor(image: HTMLCanvasElement, lines: HTMLCanvasElement, onPainted: (complete: boolean) => void) {
    this.onPainted = onPainted;
    this.bitmap = new LineBitmap(linePainter, (indices) => {
      for (const index of indices) this.changedLines.add(index);
      this.update({}, "picture");
    });
    this.imageSurface = makeSurface(image);
    this.lineSurface = makeSurface(lines);
  }

  update(part: Partial<RendererState>, ...changes: Change[]): void {
    this.state = { ...this.state, ...part };
    for (const change of changes) this.changed.add(change);
    if (this.complete) this.tellPainted();
    this.schedule();
  }

  /** Another look for some lines only. */
  updateLook(look: LineLook, indices: readonly number[]): void {
    for (const index of indices) this.changedLines.add(index);
    this.update({ look }, "highlights");
  }

  resize(screen: Size, ratio: number): void {
    this.screen = screen;
    this.ratio = ratio;
    linePainter.setScreen(screen, ratio);
    for (const surface of [this.imageSurface, this.lineSurface]) {
      resizeSurface(surface, screen, ratio);
    }
    this.update({}, "view", "image", "highlights");
    // A resized canvas is empty until it is drawn: waiting for the next frame would show a flash.
    this.draw();
  }

  stop(): void {
    if (this.frame !== null) cancelAnimationFrame(this.frame);
    if (this.restTimer !== null) clearTimeout(this.restTimer);
    this.frame = null;
    this.restTimer = null;
  }

  private schedule(): void {
    this.frame ??= requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    if (this.frame !== null) cancelAnimationFrame(this.frame);
    this.frame = null;
    const { image, imageSize, viewport } = this.state;
    const changed = new Set(this.changed);
    this.changed.clear();
    if (changed.has("view") || changed.has("image")) {
      drawImageLayer(this.imageSurface, image, imageSize, viewport, this.ratio);
    }
    this.bringUpToDate(changed);
    if ([...changed].some((change) => change !== "image")) {
      this.bitmap.copyTo(this.lineSurface, viewport, this.ratio);
      this.drawHighlights();
    }
    this.tellPainted();
  }

  private tellPainted(): void {
    const { image, scene } = this.state;
    // A finer drawing after a movement takes nothing away from what is seen.
    const drawn = image !== null && scene !== EMPTY_SCENE && (this.complete || !this.bitmap.drawing);
    if (drawn === this.complete) return;
    this.complete = drawn;
    this.onPainted(drawn);
  }

  private bringUpToDate(changed: ReadonlySet<Change>): void {
    const { scene, look, viewport } = this.state;
    if (changed.has("view")) this.drawAfterRest();
    if (changed.has("scene")) this.bitmap.reset();
    const anew = !this.redrawChanged() || changed.has("scene") || changed.has("lines");
    if (anew) this.bitmap.start({ scene, look, viewport, screen: this.screen, ratio: this.ratio });
  }

  /** Redraws the bitmap along the lines that changed; false where they are too many for that. */
  private redrawChanged(): boolean {
    const { scene, look } = this.state;
    const indices = [...this.changedLines];
    this.changedLines.clear();
    if (indices.length > MOST_REDRAWN) return false;
    if (indices.length > 0) this.bitmap.redraw(indices, scene, look);
    return true;
  }

  private drawAfterRest(): void {
    this.bitmap.cancel();
    if (this.restTimer !== null) clearTimeout(this.restTimer);
    this.restTimer = setTimeout(() => {
      this.restTimer = null;
      const drawn = this.bitmap.isDrawnFor(this.state.viewport, this.screen, this.ratio);
      if (!drawn) this.update({}, "lines");
    }, REST);
  }

  private drawHighlights(): void {
    const { scene, look, viewport, selected, hovered, companions, stages, markedGap, tool } = this.state;
    const { context } = this.lineSurface;
    if (selected !== null || hovered !== null || companions.length > 0 || tool?.draw !== undefined) {
      setScreenUnits(this.lineSurface, this.ratio);
    }
    // A trace that came for a line selected before is not drawn.
    const trace = stages !== null && stages.index === selected ? stages : null;
    if (trace === null) drawHighlights(context, scene, look, viewport, selected, hovered);
    else {
      drawHighlights(context, scene, look, viewport, null, hovered === selected ? null : hovered);
      drawStages(context, trace, viewport, markedGap);
    }
    drawCompanions(context, scene, viewport, companions);
    tool?.draw?.(context, viewport);
  }
}
