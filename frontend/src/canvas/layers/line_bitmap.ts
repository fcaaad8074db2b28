/**
 * The lines as a bitmap that moves along with the view.
 *
 * Thousands of lines take longer than a frame, so the bitmap is drawn elsewhere and taken over when it comes. A new
 * verdict redraws only the boxes along its line, here and at once. The bitmap reaches beyond the screen, so that a
 * pan brings lines in instead of an empty margin.
 */

import { type Frame, frameOf, sameFrame } from "../frame";
import { type Box, polylineReaches } from "../geometry";
import type { LinePainter } from "../line_painter";
import type { Drawing } from "../picture_task";
import type { Scene } from "../scene";
import type { Size, Viewport } from "../viewport";
import { drawLines, type LineLook } from "./line_layer";
import { packLines } from "./packed_lines";
import { boxesAlong, canvasBox, imageBox } from "./regions";
import { clearSurface, drawBitmap, makeSurface, type Surface, setScreenUnits } from "./surface";

interface Wish {
  readonly scene: Scene;
  readonly look: LineLook;
  readonly viewport: Viewport;
  readonly screen: Size;
  readonly ratio: number;
}

/** Two per vertex: what is drawn within a few ms is there sooner without a worker. */
const FEW_COORDINATES = 2_000;

const NO_FRAME: Frame = {
  viewport: { scale: 1, offsetX: 0, offsetY: 0 },
  ratio: 1,
  margin: 0,
  width: 1,
  height: 1,
};

export class LineBitmap {
  private readonly painter: LinePainter;
  private readonly arrived: (changed: readonly number[]) => void;
  private readonly surface = makeSurface(document.createElement("canvas"));
  private frame = NO_FRAME;
  private valid = false;
  /** Which scene's pictures are still wanted: what comes for another one is thrown away. */
  private generation = 0;
  /** What the picture shows that is being drawn. */
  private underWay: Frame | null = null;
  private next: Wish | null = null;
  /** Lines that changed since the picture under way was asked for. */
  private readonly changed = new Set<number>();

  /** @param arrived Hears when a picture drawn elsewhere is there, and which lines have changed since it was begun. */
  constructor(painter: LinePainter, arrived: (changed: readonly number[]) => void) {
    this.painter = painter;
    this.arrived = arrived;
  }

  /** Forgets what is drawn: the scene is another one. */
  reset(): void {
    this.generation++;
    this.valid = false;
    this.underWay = null;
    this.next = null;
    this.changed.clear();
    clearSurface(this.surface);
  }

  /** Asks for a drawing; of several that are asked for meanwhile the last one is made. */
  start(wish: Wish): void {
    this.next = wish;
    if (this.underWay === null) this.begin();
  }

  /** Takes back what nobody has begun to draw: the view has moved on. */
  cancel(): void {
    if (this.valid) this.next = null;
  }

  /** Whether what is shown, or is about to be, is drawn for just this and isn't only moved there. */
  isDrawnFor(viewport: Viewport, screen: Size, ratio: number): boolean {
    const { next } = this;
    const shown = this.underWay ?? (this.valid ? this.frame : NO_FRAME);
    const last = next === null ? shown : frameOf(next.viewport, next.screen, next.ratio);
    return sameFrame(last, frameOf(viewport, screen, ratio));
  }

  /** Whether a drawing that is asked for isn't there yet. */
  get drawing(): boolean {
    return this.underWay !== null || this.next !== null;
  }

  /** Redraws what lies along some lines; the picture under way is redrawn there once it has come. */
  redraw(indices: readonly number[], scene: Scene, look: LineLook): void {
    if (this.underWay !== null) for (const index of indices) this.changed.add(index);
    if (this.next !== null) this.next = { ...this.next, look };
    if (!this.valid) return;
    const { viewport, ratio, margin } = this.frame;
    // Box by box: a clip of one rectangle is cheap, a clip of many is not.
    for (const box of indices.flatMap((index) => boxesAlong(scene, index))) {
      const region = canvasBox(box, viewport, ratio, margin);
      const around = imageBox(region, viewport, ratio, margin);
      // Of a slanted line the box is mostly empty: most that it touches are seen elsewhere.
      const touching = scene.places
        .touching(around, look.visible)
        .filter((line) => polylineReaches(scene.line(line, viewport.scale), around));
      const lines = packLines(scene, look, viewport.scale, touching);
      drawRegion(this.surface, region, { lines, styles: look.styles, frame: this.frame });
    }
  }

  /** Copies the picture to a surface as it looks from another viewport. */
  copyTo(target: Surface, viewport: Viewport, ratio: number): void {
    clearSurface(target);
    if (!this.valid) return;
    const { viewport: drawnAt, margin, width, height } = this.frame;
    const change = viewport.scale / drawnAt.scale;
    const x = (viewport.offsetX - drawnAt.offsetX * change) * ratio - margin * change;
    const y = (viewport.offsetY - drawnAt.offsetY * change) * ratio - margin * change;
    target.context.imageSmoothingEnabled = change !== 1;
    const place = { minX: x, minY: y, maxX: x + width * change, maxY: y + height * change };
    drawBitmap(target, this.surface.canvas, place);
  }

  private begin(): void {
    const wish = this.next;
    if (wish === null) return;
    this.next = null;
    const { scene, look, viewport, screen, ratio } = wish;
    const drawing = this.painter.drawingOf(scene, look, viewport, screen, ratio);
    if (drawing.lines.coordinates.length <= FEW_COORDINATES) {
      this.drawHere(drawing);
      return;
    }
    const painted = this.painter.paint(scene, drawing);
    if (painted instanceof ImageBitmap) this.take(painted, drawing.frame);
    else this.await(painted, drawing);
  }

  private await(painted: Promise<ImageBitmap>, drawing: Drawing): void {
    const { generation } = this;
    this.underWay = drawing.frame;
    painted.then(
      (picture) => {
        if (generation === this.generation) this.come(() => this.take(picture, drawing.frame));
        else picture.close();
      },
      () => {
        if (generation === this.generation) this.come(() => this.drawHere(drawing));
      },
    );
  }

  private come(show: () => void): void {
    const changed = [...this.changed];
    this.changed.clear();
    this.underWay = null;
    show();
    this.begin();
    this.arrived(changed);
  }

  private take(picture: ImageBitmap, frame: Frame): void {
    this.use(frame);
    drawBitmap(this.surface, picture, { minX: 0, minY: 0, maxX: frame.width, maxY: frame.height });
    picture.close();
  }

  private drawHere(drawing: Drawing): void {
    const { width, height } = drawing.frame;
    this.use(drawing.frame);
    drawRegion(this.surface, { minX: 0, minY: 0, maxX: width, maxY: height }, drawing);
  }

  private use(frame: Frame): void {
    const { canvas } = this.surface;
    if (canvas.width !== frame.width) canvas.width = frame.width;
    if (canvas.height !== frame.height) canvas.height = frame.height;
    clearSurface(this.surface);
    this.frame = frame;
    this.valid = true;
  }
}

/** Draws anew everything inside a box of canvas px, and nothing outside. */
function drawRegion(surface: Surface, box: Box, { lines, styles, frame }: Drawing): void {
  const { context } = surface;
  const { minX, minY, maxX, maxY } = box;
  context.save();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.beginPath();
  context.rect(minX, minY, maxX - minX, maxY - minY);
  context.clip();
  context.clearRect(minX, minY, maxX - minX, maxY - minY);
  setScreenUnits(surface, frame.ratio, frame.margin);
  drawLines(context, lines, styles, frame.viewport);
  context.restore();
}
