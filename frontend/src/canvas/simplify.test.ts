import { describe, expect, it } from "vitest";
import { distanceToPolyline } from "./geometry";
import { simplifyLine } from "./simplify";

function noisyArc(points: number): Float32Array {
  const coordinates = new Float32Array(2 * points);
  for (let i = 0; i < points; i++) {
    coordinates[2 * i] = i;
    coordinates[2 * i + 1] = 8 * Math.sin((Math.PI * i) / points) + 0.2 * Math.sin(37 * i);
  }
  return coordinates;
}

describe("simplification", () => {
  it.each([0.1, 0.5, 2, 20])("stays within a tolerance of %d px", (tolerance) => {
    const coordinates = noisyArc(300);
    const simple = simplifyLine(coordinates, 0, 300, tolerance);
    const end = simple.length / 2;
    for (let i = 0; i < 300; i++) {
      const [x, y] = [coordinates[2 * i] as number, coordinates[2 * i + 1] as number];
      expect(distanceToPolyline(simple, 0, end, x, y)).toBeLessThanOrEqual(tolerance + 1e-4);
    }
    expect(end).toBeLessThan(300);
  });

  it("keeps a vertex that deviates by more than the tolerance, and no other", () => {
    const coordinates = Float32Array.of(0, 0, 5, 2, 10, 0);
    expect([...simplifyLine(coordinates, 0, 3, 1.9)]).toEqual([0, 0, 5, 2, 10, 0]);
    expect([...simplifyLine(coordinates, 0, 3, 2)]).toEqual([0, 0, 10, 0]);
  });

  it("leaves of a finer line what a coarser one has, in the order of the line", () => {
    const coordinates = noisyArc(300);
    let finer = Array.from({ length: 300 }, (_, i) => i);
    for (const tolerance of [0.05, 0.2, 0.8, 3]) {
      const line = simplifyLine(coordinates, 0, 300, tolerance);
      const places = [...line].filter((_, i) => i % 2 === 0);
      expect(places).toEqual([...places].sort((a, b) => a - b));
      expect(finer).toEqual(expect.arrayContaining(places));
      finer = places;
    }
  });

  it("leaves two points of a straight line", () => {
    const coordinates = Float32Array.from({ length: 600 }, (_, i) => Math.floor(i / 2));
    expect([...simplifyLine(coordinates, 0, 300, 0.01)]).toEqual([0, 0, 299, 299]);
  });

  it("keeps polylines apart, and single points", () => {
    const coordinates = Float32Array.of(0, 0, 1, 0, 2, 0, 7, 7, 0, 5, 9, 5);
    const line = (first: number, end: number) => [...simplifyLine(coordinates, first, end, 0.5)];
    expect(line(0, 3)).toEqual([0, 0, 2, 0]);
    expect(line(3, 4)).toEqual([7, 7]);
    expect(line(4, 6)).toEqual([0, 5, 9, 5]);
  });
});
