/** The selected and the hovered line, above all others, and what belongs to the selected one. */

import { at } from "../geometry";
import type { Scene } from "../scene";
import { COMPANION, SELECTION } from "../style";
import { toScreen, type Viewport } from "../viewport";
import type { LineLook } from "./line_layer";
import { strokePath, tracePolyline } from "./surface";

export function drawHighlights(
  context: CanvasRenderingContext2D,
  scene: Scene,
  look: LineLook,
  viewport: Viewport,
  selected: number | null,
  hovered: number | null,
): void {
  if (hovered !== null && hovered !== selected) drawHovered(context, scene, look, viewport, hovered);
  if (selected !== null) drawSelected(context, scene, look, viewport, selected);
}

/** Draws the lines that belong to the selected one: thin and dotted, so that both can be compared. */
export function drawCompanions(
  context: CanvasRenderingContext2D,
  scene: Scene,
  viewport: Viewport,
  companions: readonly number[],
): void {
  for (const index of companions) {
    const path = pathOf(scene, viewport, index);
    strokePath(context, path, SELECTION.casing, COMPANION.width + 2.4);
    strokePath(context, path, COMPANION.colour, COMPANION.width, COMPANION.dash);
  }
}

function drawHovered(
  context: CanvasRenderingContext2D,
  scene: Scene,
  look: LineLook,
  viewport: Viewport,
  index: number,
): void {
  const path = pathOf(scene, viewport, index);
  const style = look.style(index);
  // Without knobs at its ends and thinner than the selection, and like that with a dark rim on bright pixels.
  strokePath(context, path, SELECTION.casing, style.width + 7.6);
  strokePath(context, path, SELECTION.halo, style.width + 5);
  strokePath(context, path, SELECTION.casing, style.width + 2);
  strokePath(context, path, style.colour, style.width + 0.6, style.dash);
}

function drawSelected(
  context: CanvasRenderingContext2D,
  scene: Scene,
  look: LineLook,
  viewport: Viewport,
  index: number,
): void {
  const path = pathOf(scene, viewport, index);
  const style = look.style(index);
  strokePath(context, path, SELECTION.casing, SELECTION.width + 9);
  strokePath(context, path, SELECTION.halo, SELECTION.width + 5.6);
  strokePath(context, path, SELECTION.casing, SELECTION.width + 1.8);
  strokePath(context, path, style.colour, SELECTION.width, style.dash);
  drawEnds(context, scene, viewport, index, style.colour);
}

function drawEnds(
  context: CanvasRenderingContext2D,
  scene: Scene,
  viewport: Viewport,
  index: number,
  colour: string,
): void {
  const { coordinates, offsets } = scene.polylines;
  for (const point of [at(offsets, index), at(offsets, index + 1) - 1]) {
    const { x, y } = toScreen(viewport, at(coordinates, 2 * point), at(coordinates, 2 * point + 1));
    context.beginPath();
    context.arc(x, y, 5.5, 0, 2 * Math.PI);
    context.fillStyle = SELECTION.casing;
    context.fill();
    context.beginPath();
    context.arc(x, y, 4.4, 0, 2 * Math.PI);
    context.fillStyle = SELECTION.halo;
    context.fill();
    context.beginPath();
    context.arc(x, y, 2.4, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.fill();
  }
}

function pathOf(scene: Scene, viewport: Viewport, index: number): Path2D {
  const line = scene.line(index, viewport.scale);
  const path = new Path2D();
  tracePolyline(path, line, 0, line.length / 2, viewport);
  return path;
}
