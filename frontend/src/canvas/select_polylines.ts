import type { Polylines } from "./decode";

/** Those polylines whose ids are wanted, in their order. */
export function selectPolylines(polylines: Polylines, wanted: ReadonlySet<number>): Polylines {
  const { revision, ids, offsets, coordinates } = polylines;
  const rows = Array.from(ids.keys()).filter((row) => wanted.has(ids[row] as number));
  const parts = rows.map((row) =>
    coordinates.subarray(2 * (offsets[row] as number), 2 * (offsets[row + 1] as number)),
  );
  const total = parts.reduce((sum, part) => sum + part.length, 0);
  const selected = {
    revision,
    ids: Uint32Array.from(rows, (row) => ids[row] as number),
    offsets: new Uint32Array(rows.length + 1),
    coordinates: new Float32Array(total),
  };
  let at = 0;
  for (const [place, part] of parts.entries()) {
    selected.coordinates.set(part, at);
    at += part.length;
    selected.offsets[place + 1] = at / 2;
  }
  return selected;
}
