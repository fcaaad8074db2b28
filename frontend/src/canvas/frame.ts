/** What a bitmap of lines shows: somewhat more than the screen, so that a pan brings lines in. */

import { type Size, sameViewport, type Viewport } from "./viewport";

/** Share of the screen beyond each edge. */
const MARGIN = 0.2;

export interface Frame {
  readonly viewport: Viewport;
  /** Canvas px per CSS px. */
  readonly ratio: number;
  /** Canvas px beyond the screen on each side. */
  readonly margin: number;
  /** Of the bitmap, canvas px, margins included. */
  readonly width: number;
  readonly height: number;
}

/** @param ratio Canvas px per CSS px. */
export function frameOf(viewport: Viewport, screen: Size, ratio: number): Frame {
  const margin = Math.round(MARGIN * Math.max(screen.width, screen.height) * ratio);
  return {
    viewport,
    ratio,
    margin,
    width: Math.max(1, Math.round(screen.width * ratio) + 2 * margin),
    height: Math.max(1, Math.round(screen.height * ratio) + 2 * margin),
  };
}

export function sameFrame(a: Frame, b: Frame): boolean {
  const sameSize = a.width === b.width && a.height === b.height && a.margin === b.margin;
  return sameSize && a.ratio === b.ratio && sameViewport(a.viewport, b.viewport);
}
