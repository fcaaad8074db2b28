/**
 * The binary answer of `/api/images/{id}/points`, all little endian:
 * "CLP1", uint32 revision, S, N, then S uint32 segment ids, S + 1 uint32 offsets, N x 2 float32 points.
 */

const MAGIC = 0x31_50_4c_43;
const HEADER_BYTES = 16;
const LITTLE_ENDIAN = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;

export interface Polylines {
  /** Counts the changes of the image's segments on the server. */
  readonly revision: number;
  /** Segment ids, one per polyline. */
  readonly ids: Uint32Array;
  /** Polyline s has the points offsets[s]..offsets[s + 1] - 1. */
  readonly offsets: Uint32Array;
  /** x0, y0, x1, y1, ... in image px. */
  readonly coordinates: Float32Array;
}

/** @throws Error where the bytes aren't a complete, consistent CLP1 answer. */
export function decodePolylines(buffer: ArrayBuffer): Polylines {
  if (buffer.byteLength < HEADER_BYTES) throw new Error("The points are cut off: no complete header.");
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new Error("The points aren't in the CLP1 form.");
  const revision = view.getUint32(4, true);
  const segments = view.getUint32(8, true);
  const points = view.getUint32(12, true);
  const expected = HEADER_BYTES + 4 * (2 * segments + 1 + 2 * points);
  if (buffer.byteLength !== expected) {
    throw new Error(`The points have ${buffer.byteLength} bytes, ${expected} were announced.`);
  }
  const words = LITTLE_ENDIAN ? buffer : swapped(buffer);
  const offsetsAt = HEADER_BYTES + 4 * segments;
  const offsets = new Uint32Array(words, offsetsAt, segments + 1);
  checkOffsets(offsets, points);
  return {
    revision,
    ids: new Uint32Array(words, HEADER_BYTES, segments),
    offsets,
    coordinates: new Float32Array(words, offsetsAt + 4 * (segments + 1), 2 * points),
  };
}

function checkOffsets(offsets: Uint32Array, points: number): void {
  if (offsets[0] !== 0 || offsets[offsets.length - 1] !== points) {
    throw new Error("The points' offsets don't cover the points.");
  }
  for (let s = 1; s < offsets.length; s++) {
    if ((offsets[s] as number) <= (offsets[s - 1] as number)) {
      throw new Error(`Segment ${s - 1} has no points.`);
    }
  }
}

/** The same words in the byte order of a big-endian machine. */
function swapped(buffer: ArrayBuffer): ArrayBuffer {
  const from = new DataView(buffer);
  const to = new Uint32Array(buffer.byteLength / 4);
  for (let i = 0; i < to.length; i++) to[i] = from.getUint32(4 * i, true);
  return to.buffer;
}
