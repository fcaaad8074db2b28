/**
 * The similarity between image and screen. Screen units are CSS px from the canvas's top left corner.
 *
 * The centre of pixel (x, y) is drawn at ((x + .5) scale + offset): the image itself covers
 * [0, width] x [0, height] of the canvas plane while its first pixel's centre counts as (0, 0).
 */

import { type Box, clamp, type Point } from "./geometry";

export interface Size {
  readonly width: number;
  readonly height: number;
}

export interface Viewport {
  /** Screen px per image px. */
  readonly scale: number;
  readonly offsetX: number;
  readonly offsetY: number;
}

export const MAX_SCALE = 64;
const PIXEL_CENTRE = 0.5;
const FIT_MARGIN = 12;

export function toScreen(viewport: Viewport, x: number, y: number): Point {
  return {
    x: (x + PIXEL_CENTRE) * viewport.scale + viewport.offsetX,
    y: (y + PIXEL_CENTRE) * viewport.scale + viewport.offsetY,
  };
}

export function toImage(viewport: Viewport, x: number, y: number): Point {
  return {
    x: (x - viewport.offsetX) / viewport.scale - PIXEL_CENTRE,
    y: (y - viewport.offsetY) / viewport.scale - PIXEL_CENTRE,
  };
}

/** The scale at which the whole image is seen. */
export function fitScale(image: Size, screen: Size): number {
  const width = Math.max(1, screen.width - 2 * FIT_MARGIN);
  const height = Math.max(1, screen.height - 2 * FIT_MARGIN);
  return clamp(Math.min(width / image.width, height / image.height), 1e-3, MAX_SCALE);
}

/** The whole image, centred. */
export function fitted(image: Size, screen: Size): Viewport {
  const scale = fitScale(image, screen);
  return {
    scale,
    offsetX: (screen.width - image.width * scale) / 2,
    offsetY: (screen.height - image.height * scale) / 2,
  };
}

/** Scales by a factor so that the image stays where it is under a screen position. */
export function zoomAt(viewport: Viewport, at: Point, factor: number, minScale: number): Viewport {
  const scale = clamp(viewport.scale * factor, minScale, MAX_SCALE);
  const change = scale / viewport.scale;
  return {
    scale,
    offsetX: at.x - (at.x - viewport.offsetX) * change,
    offsetY: at.y - (at.y - viewport.offsetY) * change,
  };
}

export function pan(viewport: Viewport, dx: number, dy: number): Viewport {
  return { ...viewport, offsetX: viewport.offsetX + dx, offsetY: viewport.offsetY + dy };
}

/** Puts an image position into the middle of the screen. */
export function centreOn(position: Point, scale: number, screen: Size): Viewport {
  return {
    scale,
    offsetX: screen.width / 2 - (position.x + PIXEL_CENTRE) * scale,
    offsetY: screen.height / 2 - (position.y + PIXEL_CENTRE) * scale,
  };
}

/** Keeps a good part of the image on the screen: it can be pushed aside but never lost. */
export function keepInReach(viewport: Viewport, image: Size, screen: Size): Viewport {
  const marginX = Math.min(screen.width, image.width * viewport.scale) / 2;
  const marginY = Math.min(screen.height, image.height * viewport.scale) / 2;
  return {
    scale: viewport.scale,
    offsetX: clamp(viewport.offsetX, marginX - image.width * viewport.scale, screen.width - marginX),
    offsetY: clamp(viewport.offsetY, marginY - image.height * viewport.scale, screen.height - marginY),
  };
}

/** The part of the image plane that is seen, in image px. */
export function visibleBox(viewport: Viewport, screen: Size): Box {
  const topLeft = toImage(viewport, 0, 0);
  const bottomRight = toImage(viewport, screen.width, screen.height);
  return { minX: topLeft.x, minY: topLeft.y, maxX: bottomRight.x, maxY: bottomRight.y };
}

export function sameViewport(a: Viewport, b: Viewport): boolean {
  return a.scale === b.scale && a.offsetX === b.offsetX && a.offsetY === b.offsetY;
}
