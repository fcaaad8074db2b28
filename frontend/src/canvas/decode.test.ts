import { describe, expect, it } from "vitest";
import { decodePolylines } from "./decode";

/** Written byte by byte, independently of the decoder. */
function encode(revision: number, ids: number[], offsets: number[], points: number[]): ArrayBuffer {
  const bytes = new DataView(new ArrayBuffer(16 + 4 * (ids.length + offsets.length + points.length)));
  [..."CLP1"].forEach((letter, i) => {
    bytes.setUint8(i, letter.charCodeAt(0));
  });
  let at = 4;
  for (const word of [revision, ids.length, points.length / 2, ...ids, ...offsets]) {
    bytes.setUint32(at, word, true);
    at += 4;
  }
  for (const value of points) {
    bytes.setFloat32(at, value, true);
    at += 4;
  }
  return bytes.buffer as ArrayBuffer;
}

describe("CLP1", () => {
  it("gives ids, offsets and points as they were written", () => {
    const polylines = decodePolylines(encode(7, [41, 3], [0, 2, 3], [1.5, 2, 3, -4, 0.25, 6]));
    expect(polylines.revision).toBe(7);
    expect([...polylines.ids]).toEqual([41, 3]);
    expect([...polylines.offsets]).toEqual([0, 2, 3]);
    expect([...polylines.coordinates]).toEqual([1.5, 2, 3, -4, 0.25, 6]);
  });

  it("reads an image without segments", () => {
    const polylines = decodePolylines(encode(1, [], [0], []));
    expect(polylines.ids.length).toBe(0);
    expect(polylines.coordinates.length).toBe(0);
  });

  it.each([
    ["nothing", new ArrayBuffer(0), /header/],
    ["another form", new TextEncoder().encode("CLP2 and something else").buffer, /CLP1/],
    ["a missing byte", encode(1, [5], [0, 1], [1, 2]).slice(0, -1), /bytes/],
    ["offsets that stop early", encode(1, [5], [0, 1], [1, 2, 3, 4]), /cover/],
    ["a segment without points", encode(1, [5, 6], [0, 2, 2], [1, 2, 3, 4]), /Segment 1/],
  ])("refuses %s", (_, buffer, message) => {
    expect(() => decodePolylines(buffer)).toThrow(message);
  });
});
