import { describe, expect, it } from "vitest";
import { boxContains, boxOf, distanceToPolyline, polylineReaches, squaredDistanceToPiece } from "./geometry";

const corner = Float32Array.of(0, 0, 10, 0, 10, 10);

describe("distance to a line piece", () => {
  it("is perpendicular beside the piece and to the end beyond it", () => {
    expect(squaredDistanceToPiece(5, 3, 0, 0, 10, 0)).toBe(9);
    expect(squaredDistanceToPiece(13, 4, 0, 0, 10, 0)).toBe(25);
    expect(squaredDistanceToPiece(-3, 4, 0, 0, 10, 0)).toBe(25);
  });

  it("is to the point where both ends are one", () => {
    expect(squaredDistanceToPiece(3, 4, 0, 0, 0, 0)).toBe(25);
  });
});

describe("distance to a polyline", () => {
  it("is to the nearest piece", () => {
    expect(distanceToPolyline(corner, 0, 3, 12, 5)).toBe(2);
    expect(distanceToPolyline(corner, 0, 3, 5, -1)).toBe(1);
  });

  it("takes only the points it is given", () => {
    expect(distanceToPolyline(corner, 0, 2, 10, 10)).toBe(10);
    expect(distanceToPolyline(corner, 2, 3, 10, 13)).toBe(3);
  });
});

describe("boxes", () => {
  it("enclose exactly the given points", () => {
    expect(boxOf(corner, 1, 3)).toEqual({ minX: 10, minY: 0, maxX: 10, maxY: 10 });
  });

  it("contain themselves but nothing that sticks out", () => {
    const box = boxOf(corner, 0, 3);
    expect(boxContains(box, box)).toBe(true);
    expect(boxContains(box, { ...box, maxX: 10.5 })).toBe(false);
  });
});

describe("a polyline reaches a box", () => {
  const box = { minX: 2, minY: 2, maxX: 4, maxY: 5 };
  const reaches = (...line: number[]) => polylineReaches(Float32Array.from(line), box);

  it("where it ends in it, goes through it or touches it", () => {
    expect(reaches(0, 0, 3, 3)).toBe(true);
    expect(reaches(0, 6, 6, 0)).toBe(true);
    expect(reaches(4, 0, 4, 9)).toBe(true);
    expect(reaches(0, 4, 4, 0)).toBe(true);
    expect(reaches(20, 20, 9, 3, 3, 3)).toBe(true);
    expect(reaches(3, 4)).toBe(true);
  });

  it("and not where only its own box does", () => {
    expect(reaches(0, 3.5, 3.5, 0)).toBe(false);
    expect(reaches(0, 0, 0, 9, 9, 9, 9, 0)).toBe(false);
    expect(reaches(5, 0, 5, 9)).toBe(false);
    expect(reaches(1, 1)).toBe(false);
  });
});
