import { describe, expect, it } from "vitest";
import { makeScene } from "../scene";
import type { LineStyle } from "../style";
import { packLines, sameLines } from "./packed_lines";

const scene = makeScene({
  revision: 1,
  ids: Uint32Array.of(11, 12, 13),
  offsets: Uint32Array.of(0, 3, 5, 8),
  coordinates: Float32Array.of(0, 0, 50, 0, 100, 0, 0, 10, 100, 10, 0, 20, 50, 26, 100, 20),
});
const keep: LineStyle = { colour: "#00ff00", width: 2, dash: [], opacity: 1 };
const reject: LineStyle = { colour: "#ff0000", width: 1, dash: [], opacity: 1 };
const look = {
  styles: [reject, keep],
  style: (index: number) => (index === 2 ? keep : reject),
  visible: (index: number) => index !== 1,
};

describe("packed lines", () => {
  it("are the visible ones in the scene's order, with their styles and no vertex too many", () => {
    const lines = packLines(scene, look, 1, [2, 1, 0]);
    expect([...lines.indices]).toEqual([0, 2]);
    expect([...lines.styles]).toEqual([0, 1]);
    expect([...lines.offsets]).toEqual([0, 2, 5]);
    expect([...lines.coordinates]).toEqual([0, 0, 100, 0, 0, 20, 50, 26, 100, 20]);
  });

  it("are the same where lines and styles are", () => {
    const lines = packLines(scene, look, 1, [0, 2]);
    expect(sameLines(lines, packLines(scene, look, 1, [2, 0]))).toBe(true);
    expect(sameLines(lines, packLines(scene, look, 1, [2]))).toBe(false);
    expect(sameLines(lines, packLines(scene, { ...look, style: () => reject }, 1, [0, 2]))).toBe(false);
    expect(sameLines(lines, packLines(scene, { ...look, visible: () => true }, 1, [0, 1, 2]))).toBe(false);
  });
});
