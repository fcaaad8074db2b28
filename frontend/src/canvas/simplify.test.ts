import { describe, expect, it } from "vitest";
import { distanceToPolyline } from "./geometry";
import { simplify, vertexTolerances } from "./simplify";

const whole = (coordinates: Float32Array) => Uint32Array.of(0, coordinates.length / 2);

function noisyArc(points: number): Float32Array {
  const coordinates = new Float32Array(2 * points);
  for (let i = 0; i < points; i++) {
    coordinates[2 * i] = i;
    coordinates[2 * i + 1] = 8 * Math.sin((Math.PI * i) / points) + 0.2 * Math.sin(37 * i);
  }
  return coordinates;
}

describe("vertex tolerances", () => {
  it("are each vertex's deviation, and infinite at the ends", () => {
    const coordinates = Float32Array.of(0, 0, 5, 2, 10, 0);
    expect([...vertexTolerances(coordinates, whole(coordinates))]).toEqual([Infinity, 2, Infinity]);
  });

  it("never exceed those of the vertex that split the piece", () => {
    // Seen from the split at (10, 1), the vertex at (5, 6) deviates far more than the split itself did.
    const coordinates = Float32Array.of(0, 0, 5, -3, 10, 4, 15, -3, 20, 0);
    const tolerances = vertexTolerances(coordinates, whole(coordinates));
    expect(tolerances[2]).toBe(4);
    expect(tolerances[1]).toBe(4);
    expect(tolerances[3]).toBe(4);
  });

  it("are zero on a straight line, of which two points remain", () => {
    const coordinates = Float32Array.from({ length: 600 }, (_, i) => Math.floor(i / 2));
    const tolerances = vertexTolerances(coordinates, whole(coordinates));
    const { offsets } = simplify(coordinates, whole(coordinates), tolerances, 0.01);
    expect([...offsets]).toEqual([0, 2]);
  });
});

describe("simplification", () => {
  it.each([0.1, 0.5, 2, 20])("stays within a tolerance of %d px", (tolerance) => {
    const coordinates = noisyArc(300);
    const offsets = whole(coordinates);
    const simple = simplify(coordinates, offsets, vertexTolerances(coordinates, offsets), tolerance);
    const end = simple.offsets[1] as number;
    for (let i = 0; i < 300; i++) {
      const [x, y] = [coordinates[2 * i] as number, coordinates[2 * i + 1] as number];
      expect(distanceToPolyline(simple.coordinates, 0, end, x, y)).toBeLessThanOrEqual(tolerance + 1e-4);
    }
    expect(end).toBeLessThan(300);
  });

  it("keeps polylines apart, and single points", () => {
    const coordinates = Float32Array.of(0, 0, 1, 0, 2, 0, 7, 7, 0, 5, 9, 5);
    const offsets = Uint32Array.of(0, 3, 4, 6);
    const simple = simplify(coordinates, offsets, vertexTolerances(coordinates, offsets), 0.5);
    expect([...simple.offsets]).toEqual([0, 2, 3, 5]);
    expect([...simple.coordinates]).toEqual([0, 0, 2, 0, 7, 7, 0, 5, 9, 5]);
  });
});
