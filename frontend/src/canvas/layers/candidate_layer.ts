/** Candidates as lines, merged into few paths per style: casings first, so that none covers a neighbour's colour. */

import type { Verdict } from "../../api/types";
import { at } from "../geometry";
import type { Scene } from "../scene";
import { CASING, lineStyle, STYLE_ORDER, type StyleName, styleName } from "../style";
import type { Viewport } from "../viewport";
import { tracePolyline } from "./surface";

/** Candidates that share a path: one path for all takes browsers thrice as long, one for each longer too. */
const PER_PATH = 8;

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
  const paths = new Map<StyleName, Map<number, Path2D>>();
  for (const index of indices) {
    if (!look.visible(index)) continue;
    const name = styleName(look.verdict(index), look.bent(index));
    const ofStyle = paths.get(name) ?? new Map<number, Path2D>();
    paths.set(name, ofStyle);
    // By index, so that a part that is drawn again looks as it did.
    const part = Math.floor(index / PER_PATH);
    const path = ofStyle.get(part) ?? new Path2D();
    ofStyle.set(part, path);
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
  paths: ReadonlyMap<number, Path2D> | undefined,
  colour: string,
  extra: number,
): void {
  if (paths === undefined) return;
  const { opacity, dash, width } = lineStyle(name);
  context.globalAlpha = opacity;
  context.setLineDash([...dash]);
  context.lineWidth = width + extra;
  context.strokeStyle = colour;
  for (const path of paths.values()) context.stroke(path);
}
