import { describe, expect, it } from "vitest";
import { join, stageHistory } from "../labelling/test_stages";
import type { Polylines } from "./decode";
import { middleOf, traceStages } from "./stage_trace";

/** Two polylines; the second one goes in steps of 10 px along y = 0 and has a kink up at x = 50. */
function polylines(): Polylines {
  const first = [0, 9, 5, 9];
  const second = [0, 0, 10, 0, 20, 0, 30, 0, 40, 0, 50, 2, 60, 0, 70, 0, 80, 0, 90, 0, 100, 0];
  return {
    revision: 1,
    ids: Uint32Array.of(7, 8),
    offsets: Uint32Array.of(0, 2, 13),
    coordinates: Float32Array.from([...first, ...second]),
  };
}

function piece(from: number, to: number) {
  return { start: [from, 0] as [number, number], end: [to, 0] as [number, number], length: to - from };
}

const xs = (part: Float32Array) => Array.from(part).filter((_, i) => i % 2 === 0);

describe("a trace", () => {
  it("follows the candidate's own points from the ends of each piece", () => {
    const history = stageHistory({ pieces: [piece(5, 34), piece(36, 100)], joins: [join(34, 36)] });
    const trace = traceStages(polylines(), 1, history);
    expect(trace.pieces.map(xs)).toEqual([
      [5, 10, 20, 30, 34],
      [36, 40, 50, 60, 70, 80, 90, 100],
    ]);
    expect(Array.from(trace.pieces[1] as Float32Array).slice(4, 6)).toEqual([50, 2]);
    expect(trace.gaps.map(xs)).toEqual([[34, 36]]);
    expect(trace.whole.length).toBe(22);
  });

  it("has what was added before the first piece and after the last", () => {
    const history = stageHistory({ pieces: [piece(15, 85)], extended: [15, 15] });
    expect(traceStages(polylines(), 1, history).added.map(xs)).toEqual([
      [0, 10, 15],
      [85, 90, 100],
    ]);
    expect(traceStages(polylines(), 1, stageHistory({ pieces: [piece(15, 85)] })).added).toEqual([]);
  });

  it("leaves out pieces that were cut off, and ends where the candidate ends", () => {
    const history = stageHistory({
      pieces: [piece(-40, -10), piece(-5, 110)],
      joins: [join(-10, -5)],
      trimmed: [40, 10],
    });
    const trace = traceStages(polylines(), 1, history);
    expect(trace.pieces.map(xs)).toEqual([[0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100]]);
    // the join keeps its place in the list
    expect(trace.gaps.map(xs)).toEqual([[0, 0]]);
  });

  it("tells where to look for a gap", () => {
    const trace = traceStages(polylines(), 1, stageHistory({ joins: [join(20, 30)] }));
    expect(middleOf(trace.gaps[0] as Float32Array)).toEqual({ x: 25, y: 0 });
  });

  it("of a single point holds together", () => {
    const single = { ...polylines(), offsets: Uint32Array.of(0, 1), coordinates: Float32Array.of(3, 4) };
    const trace = traceStages(single, 0, stageHistory({ extended: [5, 5] }));
    expect([trace.pieces, trace.added]).toEqual([[], []]);
  });
});
