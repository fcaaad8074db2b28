/**
 * Polyline simplification after Douglas and Peucker, "Algorithms for the reduction of the number of points
 * required to represent a digitized line or its caricature", Cartographica 10 (1973).
 *
 * Only what is drawn is simplified, never what is stored.
 */

/**
 * The vertices first..end - 1 without those that lie within a tolerance (px) of what is left: x0, y0, x1, y1, ...
 * The ends stay. A greater tolerance leaves only vertices that a smaller one leaves too.
 */
export function simplifyLine(
  coordinates: Float32Array,
  first: number,
  end: number,
  tolerance: number,
): Float32Array {
  const last = end - 1;
  const kept = [first];
  // The pieces still to be looked at, the next one on top, so that vertices are met in their order.
  const ends = [last];
  let start = first;
  while (ends.length > 0) {
    const stop = ends.at(-1) as number;
    const index = stop - start < 2 ? null : farthest(coordinates, start, stop, tolerance);
    if (index !== null) {
      ends.push(index);
      continue;
    }
    ends.pop();
    if (stop > start) kept.push(stop);
    start = stop;
  }
  const line = new Float32Array(2 * kept.length);
  kept.forEach((index, place) => {
    line[2 * place] = coordinates[2 * index] as number;
    line[2 * place + 1] = coordinates[2 * index + 1] as number;
  });
  return line;
}

/** The vertex between two others that lies farthest from the straight piece between them; null within a tolerance. */
function farthest(coordinates: Float32Array, start: number, end: number, tolerance: number): number | null {
  // Everything that depends on the piece alone stays out of the loop: it runs for every vertex at every depth.
  const ax = coordinates[2 * start] as number;
  const ay = coordinates[2 * start + 1] as number;
  const dx = (coordinates[2 * end] as number) - ax;
  const dy = (coordinates[2 * end + 1] as number) - ay;
  const square = dx * dx + dy * dy;
  const inverse = square === 0 ? 0 : 1 / square;
  let index = start + 1;
  let most = -1;
  for (let i = start + 1; i < end; i++) {
    const px = (coordinates[2 * i] as number) - ax;
    const py = (coordinates[2 * i + 1] as number) - ay;
    const along = (px * dx + py * dy) * inverse;
    const t = along < 0 ? 0 : along > 1 ? 1 : along;
    const ex = px - t * dx;
    const ey = py - t * dy;
    const distance = ex * ex + ey * ey;
    if (distance > most) {
      most = distance;
      index = i;
    }
  }
  return most > tolerance * tolerance ? index : null;
}
