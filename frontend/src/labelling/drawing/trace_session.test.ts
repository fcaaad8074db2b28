import { beforeEach, describe, expect, it } from "vitest";
import { RequestFailed, unreachable } from "../../api/problem";
import type { Trace } from "../../api/types";
import { TraceSession } from "./trace_session";
import { TraceTool } from "./trace_tool";

type Wanted = { points: [number, number][]; reach: number; straight: boolean };

const at = (x: number, y = 0) => ({ x, y });
const NO_EDGE = new RequestFailed({ title: "", status: 422, code: "no-edge", message: "no edge" });

let asked: { wanted: Wanted; answer: (result: Trace | RequestFailed) => void }[];
let saved: { points: Trace["points"]; clientId: string }[];
let refusal: RequestFailed | null;
let session: TraceSession;
let ids: number;

beforeEach(() => {
  asked = [];
  saved = [];
  refusal = null;
  ids = 0;
  session = new TraceSession({
    trace: (wanted) =>
      new Promise((resolve, reject) => {
        asked.push({
          wanted,
          answer: (result) => (result instanceof RequestFailed ? reject(result) : resolve(result)),
        });
      }),
    save: async (points, clientId) => {
      saved.push({ points, clientId });
      if (refusal !== null) throw refusal;
    },
    scale: () => 2,
    newId: () => `id-${++ids}`,
  });
});

const trace = (length: number): Trace => ({
  points: [
    [0, 0],
    [length, 0],
  ],
  length,
  residual: 0.02,
});

const settled = () => new Promise((resolve) => setTimeout(resolve));

async function answer(result: Trace | RequestFailed): Promise<void> {
  await settled();
  asked.shift()?.answer(result);
  await settled();
}

describe("a line on its way", () => {
  it("is traced between two clicks, with a reach that is the same on the screen", async () => {
    session.click(at(0));
    expect(asked).toHaveLength(0);
    session.click(at(100));
    expect(asked[0]?.wanted).toEqual({
      points: [
        [0, 0],
        [100, 0],
      ],
      reach: 4,
      straight: false,
    });
    await answer(trace(100));
    expect(session.getState().trace?.length).toBe(100);
  });

  it("follows the pointer after the first click, one request at a time", async () => {
    session.click(at(0));
    for (const x of [10, 20, 30]) session.hover(at(x));
    expect(asked).toHaveLength(1);
    await answer(trace(10));
    expect(session.getState().trace?.length).toBe(10);
    expect(asked.map(({ wanted }) => wanted.points[1]?.[0])).toEqual([30]);
    session.hover(null);
    await answer(trace(30));
    expect(session.getState().trace).toBeNull();
  });

  it("shows no answer for points that are others by now", async () => {
    session.click(at(0));
    session.click(at(100));
    session.removeLast();
    session.click(at(50));
    await answer(trace(100));
    expect(session.getState().trace).toBeNull();
    await answer(trace(50));
    expect(session.getState().trace?.length).toBe(50);
  });

  it("is saved once it is traced, and leaves room for the next", async () => {
    session.click(at(0));
    session.click(at(100));
    const accepted = session.accept();
    expect(saved).toHaveLength(0);
    await answer(trace(100));
    expect(await accepted).toBe(true);
    expect(saved[0]?.points).toEqual(trace(100).points);
    expect(session.getState().clicks).toEqual([]);
    expect(await session.accept()).toBe(false);
  });

  it("stays where it can't be saved, and is the same line when it is sent again", async () => {
    session.click(at(0));
    session.click(at(100));
    await answer(trace(100));
    refusal = unreachable();
    expect(await session.accept()).toBe(false);
    expect(session.getState()).toMatchObject({ problem: { code: "unreachable" }, saving: false });
    expect(session.getState().trace?.length).toBe(100);
    refusal = null;
    expect(await session.accept()).toBe(true);
    expect(saved[0]?.clientId).toBe(saved[1]?.clientId);
  });

  it("is asked for again where the network was away, but not where no edge runs", async () => {
    session.click(at(0));
    session.click(at(100));
    await answer(unreachable());
    const accepted = session.accept();
    await answer(NO_EDGE);
    expect(await accepted).toBe(false);
    expect(await session.accept()).toBe(false);
    expect(asked).toHaveLength(0);
    const kept = session.keepStraight();
    expect(asked[0]?.wanted.straight).toBe(true);
    await answer(trace(101));
    expect(await kept).toBe(true);
    expect(saved).toHaveLength(1);
  });
});

describe("the tool that traces", () => {
  let time: number;
  let accepted: number;
  let tool: TraceTool;

  beforeEach(() => {
    time = 0;
    accepted = 0;
    tool = new TraceTool({
      session,
      accept: () => {
        accepted++;
      },
      now: () => time,
      inside: ({ x, y }) => at(Math.max(x, 0), y),
    });
  });

  function click(x: number, when: number): void {
    time = when;
    tool.down(at(x), at(2 * x));
    tool.up(at(x), at(2 * x));
  }

  it("puts a point for a click, inside the image, and accepts with a double click", () => {
    click(-5, 0);
    click(80, 1000);
    expect(session.getState().clicks.map(({ x }) => x)).toEqual([0, 80]);
    click(80, 1200);
    expect(accepted).toBe(1);
    expect(session.getState().clicks).toHaveLength(2);
  });

  it("takes two quick clicks at different places for two points", () => {
    click(10, 0);
    click(80, 100);
    expect(accepted).toBe(0);
    expect(session.getState().clicks).toHaveLength(2);
  });

  it("puts both ends with a drag", () => {
    tool.down(at(10), at(20));
    tool.move(at(40), at(80));
    tool.up(at(90), at(180));
    expect(session.getState().clicks.map(({ x }) => x)).toEqual([10, 90]);
  });
});
