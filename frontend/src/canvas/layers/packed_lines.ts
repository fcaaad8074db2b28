/** Lines as numbers only: what a worker needs to draw them, and what tells whether two drawings would be the same. */

import type { Scene } from "../scene";
import type { LineLook } from "./line_layer";

export interface PackedLines {
  /** Place of each line in the scene, rising. */
  readonly indices: Uint32Array;
  /** Place of each line's style among the styles of its look. */
  readonly styles: Uint8Array;
  /** Line l has the vertices offsets[l]..offsets[l + 1] - 1. */
  readonly offsets: Uint32Array;
  /** x0, y0, x1, y1, ... in image px, as coarse as the scale allows. */
  readonly coordinates: Float32Array;
}

/**
 * Packs those of the given lines that are visible.
 *
 * @param indices Any order; lines lie over each other as in every other drawing.
 * @param scale Screen px per image px.
 */
export function packLines(
  scene: Scene,
  look: LineLook,
  scale: number,
  indices: readonly number[],
): PackedLines {
  const visible = Uint32Array.from(indices.filter(look.visible)).sort();
  const places = new Map(look.styles.map((style, place) => [style, place]));
  const styles = new Uint8Array(visible.length);
  const offsets = new Uint32Array(visible.length + 1);
  const lines: Float32Array[] = [];
  visible.forEach((index, place) => {
    const line = scene.line(index, scale);
    lines.push(line);
    styles[place] = places.get(look.style(index)) ?? 0;
    offsets[place + 1] = (offsets[place] as number) + line.length / 2;
  });
  const coordinates = new Float32Array(2 * (offsets[visible.length] as number));
  lines.forEach((line, place) => {
    coordinates.set(line, 2 * (offsets[place] as number));
  });
  return { indices: visible, styles, offsets, coordinates };
}

/** Whether the same lines of a scene are drawn in the same styles; at one scale the drawings are the same then. */
export function sameLines(a: PackedLines, b: PackedLines): boolean {
  return sameNumbers(a.indices, b.indices) && sameNumbers(a.styles, b.styles);
}

function sameNumbers(a: Uint8Array | Uint32Array, b: Uint8Array | Uint32Array): boolean {
  return a.length === b.length && a.every((value, place) => value === b[place]);
}
