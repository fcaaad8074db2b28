/**
 * The lines as a bitmap that moves along with the view.
 *
 * It is drawn tile by tile, a few per frame, because thousands of lines take longer than a frame. A new
 * verdict redraws only the boxes along its line. The bitmap reaches beyond the screen, so that a pan brings
 * lines in instead of an empty margin.
 */

import type { Box } from "../geometry";
import type { Scene } from "../scene";
import type { Size, Viewport } from "../viewport";
import { drawLines, type LineLook } from "./line_layer";
import { clearSurface, makeSurface, resizeSurface, type Surface, setScreenUnits } from "./surface";
import { boxesAlong, canvasBox, imageBox, tilesOf } from "./tiles";

/** Share of the screen that the bitmap holds beyond each edge. */
const MARGIN = 0.2;
/** Time for drawing within one frame (ms), so that nothing stutters meanwhile. */
const FRAME_BUDGET = 3;

interface Picture {
  readonly surface: Surface;
  viewport: Viewport;
  ratio: number;
  /** Canvas px beyond the screen on each side. */
  margin: number;
}

export class LineBitmap {
  private shown = makePicture();
  private spare = makePicture();
  private tiles: Box[] = [];
  private target = this.shown;
  private valid = false;

  /** Forgets what is drawn: the scene is another one. */
  reset(): void {
    this.valid = false;
    this.tiles = [];
    clearSurface(this.shown.surface);
  }

  /** Starts a drawing for a viewport; `drawTiles` does the work. */
  start(scene: Scene, viewport: Viewport, screen: Size, ratio: number): void {
    this.target = this.valid ? this.spare : this.shown;
    const { surface } = this.target;
    const margin = Math.round(MARGIN * Math.max(screen.width, screen.height) * ratio);
    Object.assign(this.target, { viewport, ratio, margin });
    resizeSurface(surface, screen, ratio, margin);
    clearSurface(surface);
    const whole = { minX: 0, minY: 0, maxX: surface.canvas.width, maxY: surface.canvas.height };
    const seen = scene.places.touching(imageBox(whole, viewport, ratio, margin)).length;
    // A line that tiles share is drawn in each: the first drawing is faster without them.
    this.tiles = this.valid ? tilesOf(surface.canvas.width, surface.canvas.height, seen) : [whole];
  }

  /** Leaves a drawing that a movement has made useless. */
  cancel(): void {
    if (this.valid) this.tiles = [];
  }

  get drawing(): boolean {
    return this.tiles.length > 0;
  }

  /** Draws tiles for about as long as one frame has; after the last one the new picture is what is shown. */
  drawTiles(scene: Scene, look: LineLook): void {
    const end = performance.now() + FRAME_BUDGET;
    do this.drawTile(scene, look);
    while (this.drawing && performance.now() < end);
  }

  private drawTile(scene: Scene, look: LineLook): void {
    const tile = this.tiles.shift();
    if (tile === undefined) return;
    drawRegion(this.target, tile, scene, look);
    if (this.tiles.length > 0) return;
    if (this.target !== this.shown) [this.shown, this.spare] = [this.spare, this.shown];
    this.valid = true;
  }

  /** Redraws what lies along some lines, in the picture that is shown. */
  redraw(indices: readonly number[], scene: Scene, look: LineLook): void {
    const { viewport, ratio, margin } = this.shown;
    // Box by box: a clip of one rectangle is cheap, a clip of many is not.
    for (const box of indices.flatMap((index) => boxesAlong(scene, index))) {
      drawRegion(this.shown, canvasBox(box, viewport, ratio, margin), scene, look);
    }
  }

  /** Copies the picture to a surface as it looks from another viewport. */
  copyTo(target: Surface, viewport: Viewport, ratio: number): void {
    clearSurface(target);
    const { surface, viewport: drawnAt, margin } = this.shown;
    const change = viewport.scale / drawnAt.scale;
    const x = (viewport.offsetX - drawnAt.offsetX * change) * ratio - margin * change;
    const y = (viewport.offsetY - drawnAt.offsetY * change) * ratio - margin * change;
    const { width, height } = surface.canvas;
    target.context.imageSmoothingEnabled = change !== 1;
    target.context.drawImage(surface.canvas, x, y, width * change, height * change);
  }
}

function makePicture(): Picture {
  return {
    surface: makeSurface(document.createElement("canvas")),
    viewport: { scale: 1, offsetX: 0, offsetY: 0 },
    ratio: 1,
    margin: 0,
  };
}

/** Draws anew everything inside a box of canvas px, and nothing outside. */
function drawRegion(picture: Picture, box: Box, scene: Scene, look: LineLook): void {
  const { surface, viewport, ratio, margin } = picture;
  const { context } = surface;
  const { minX, minY, maxX, maxY } = box;
  context.save();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.beginPath();
  context.rect(minX, minY, maxX - minX, maxY - minY);
  context.clip();
  context.clearRect(minX, minY, maxX - minX, maxY - minY);
  setScreenUnits(surface, ratio, margin);
  // Always in the same order, so that lines lie over each other as in every other drawing.
  const indices = scene.places.touching(imageBox(box, viewport, ratio, margin)).sort((a, b) => a - b);
  drawLines(context, scene, look, viewport, indices);
  context.restore();
}
