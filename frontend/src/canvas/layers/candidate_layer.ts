/** Candidates as lines, one merged path per style: casings first, so that none covers a neighbour's colour. */

import type { Verdict } from "../../api/types";
import { at } from "../geometry";
import type { Scene } from "../scene";
import { CASING, lineStyle, STYLE_ORDER, type StyleName, styleName } from "../style";
import type { Viewport } from "../viewport";
import { tracePolyline } from "./surface";

/** What a drawing has to know of each candidate, by index in the scene. */
export interface CandidateLook {
  readonly verdict: (index: number) => Verdict;
  readonly bent: (index: number) => boolean;
  readonly visible: (index: number) => boolean;
}

/** Draws the given candidates; the context is in CSS px of the screen. */
export function drawCandidates(
  context: CanvasRenderingContext2D,
  scene: Scene,
  look: CandidateLook,
  viewport: Viewport,
  indices: Iterable<number>,
): void {
  const { offsets, coordinates } = scene.atScale(viewport.scale);
  const paths = new Map<StyleName, Path2D>();
  for (const index of indices) {
    if (!look.visible(index)) continue;
    const name = styleName(look.verdict(index), look.bent(index));
    const path = paths.get(name) ?? new Path2D();
    paths.set(name, path);
    tracePolyline(path, coordinates, at(offsets, index), at(offsets, index + 1), viewport);
  }
  // Between the shallow angles of an edge a round joint looks the same and takes far longer.
  context.lineJoin = "bevel";
  context.lineCap = "butt";
  for (const name of STYLE_ORDER) {
    strokeStyle(context, name, paths.get(name), CASING.colour, CASING.extra);
  }
  for (const name of STYLE_ORDER) strokeStyle(context, name, paths.get(name), lineStyle(name).colour, 0);
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function strokeStyle(
  context: CanvasRenderingContext2D,
  name: StyleName,
  path: Path2D | undefined,
  colour: string,
  extra: number,
): void {
  if (path === undefined) return;
  const { opacity, dash, width } = lineStyle(name);
  context.globalAlpha = opacity;
  context.setLineDash([...dash]);
  context.lineWidth = width + extra;
  context.strokeStyle = colour;
  context.stroke(path);
}
