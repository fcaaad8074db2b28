import type { Size, Viewport } from "../viewport";
import { clearSurface, type Surface, setScreenUnits } from "./surface";

/** Beyond this many screen px per image px the pixels themselves are what one wants to see. */
const PIXELS_VISIBLE = 3;

export function drawImageLayer(
  surface: Surface,
  image: CanvasImageSource | null,
  size: Size,
  viewport: Viewport,
  ratio: number,
): void {
  clearSurface(surface);
  if (image === null) return;
  const { context } = surface;
  setScreenUnits(surface, ratio);
  context.imageSmoothingEnabled = viewport.scale < PIXELS_VISIBLE;
  context.imageSmoothingQuality = viewport.scale < 0.5 ? "medium" : "low";
  context.drawImage(
    image,
    viewport.offsetX,
    viewport.offsetY,
    size.width * viewport.scale,
    size.height * viewport.scale,
  );
}
