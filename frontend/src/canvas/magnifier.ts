/** Three close-ups of a line: its start, its middle and its end, pixels visible. */

import { at } from "./geometry";
import { type Surface, setScreenUnits, tracePolyline } from "./layers/surface";
import type { Scene } from "./scene";
import { CASING } from "./style";
import { centreOn, type Size } from "./viewport";

/** Screen px per image px. */
export const MAGNIFICATION = 5;
const GAP = 4;

export function drawMagnifier(
  surface: Surface,
  size: Size,
  ratio: number,
  image: CanvasImageSource,
  imageSize: Size,
  scene: Scene,
  index: number,
  colour: string,
): void {
  const { context } = surface;
  const { coordinates, offsets } = scene.polylines;
  const first = at(offsets, index);
  const end = at(offsets, index + 1);
  const pane: Size = { width: (size.width - 2 * GAP) / 3, height: size.height };
  const places = [first, Math.floor((first + end - 1) / 2), end - 1];
  places.forEach((point, place) => {
    const centre = { x: at(coordinates, 2 * point), y: at(coordinates, 2 * point + 1) };
    const viewport = centreOn(centre, MAGNIFICATION, pane);
    setScreenUnits(surface, ratio);
    context.save();
    context.translate(place * (pane.width + GAP), 0);
    context.beginPath();
    context.roundRect(0, 0, pane.width, pane.height, 4);
    context.clip();
    context.fillStyle = "#000";
    context.fillRect(0, 0, pane.width, pane.height);
    context.imageSmoothingEnabled = false;
    context.drawImage(
      image,
      viewport.offsetX,
      viewport.offsetY,
      imageSize.width * viewport.scale,
      imageSize.height * viewport.scale,
    );
    context.beginPath();
    tracePolyline(context, coordinates, first, end, viewport);
    context.lineJoin = "round";
    context.lineCap = "round";
    context.strokeStyle = CASING.colour;
    context.lineWidth = 2.6;
    context.stroke();
    context.strokeStyle = colour;
    context.lineWidth = 1.2;
    context.stroke();
    context.restore();
  });
}
