import { describe, expect, it } from "vitest";
import type { ImageSegments } from "../api/types";
import { makeScene, type Scene } from "../canvas/scene";
import { loadAnnotations } from "./annotations";
import { KnownScenes } from "./known_scenes";
import { candidate } from "./test_candidates";

function sceneOf(revision: number, ids: number[]): Scene {
  return makeScene({
    revision,
    ids: Uint32Array.from(ids),
    offsets: Uint32Array.from({ length: ids.length + 1 }, (_, i) => 2 * i),
    coordinates: new Float32Array(4 * ids.length),
  });
}

/** A server whose candidates can be changed; it knows how often it was asked for points. */
function serverWith(revision: number, ids: number[]) {
  const state = { revision, ids, pointRequests: 0 };
  const sources = {
    known: new KnownScenes(),
    segments: async (id: number): Promise<ImageSegments> => ({
      image_id: id,
      revision: state.revision,
      last_decision_id: 0,
      width: 20,
      height: 10,
      segments: [...state.ids].reverse().map((segment) => candidate(segment)),
    }),
    scene: async () => {
      state.pointRequests++;
      return sceneOf(state.revision, state.ids);
    },
  };
  return { state, load: () => loadAnnotations(7, sources) };
}

describe("annotations", () => {
  it("have the candidates in the order of the points", async () => {
    const { load } = serverWith(1, [4, 5, 6]);
    const { candidates } = await load();
    expect(candidates.map(({ id }) => id)).toEqual([4, 5, 6]);
  });

  it("are loaded again without their points as long as these are the same", async () => {
    const { state, load } = serverWith(1, [4, 5]);
    const first = await load();
    const second = await load();
    expect(second.scene).toBe(first.scene);
    expect(second).not.toBe(first);
    expect(state.pointRequests).toBe(1);
  });

  it.each([
    ["another revision", { revision: 2, ids: [4, 5] }],
    ["other candidates", { revision: 1, ids: [4] }],
  ])("are loaded whole with %s", async (_, change) => {
    const { state, load } = serverWith(1, [4, 5]);
    await load();
    Object.assign(state, change);
    const { scene, candidates } = await load();
    expect([...scene.polylines.ids]).toEqual(change.ids);
    expect(candidates).toHaveLength(change.ids.length);
    expect(state.pointRequests).toBe(2);
  });

  it("give up when points and candidates never belong together", async () => {
    const { state } = serverWith(1, [4]);
    const sources = {
      known: new KnownScenes(),
      segments: async () => ({ ...(await serverWith(2, [4]).load()), segments: [] }) as never,
      scene: async () => sceneOf(state.revision++, [4]),
    };
    await expect(loadAnnotations(7, sources)).rejects.toThrow("keep changing");
  });
});

describe("known scenes", () => {
  it("are forgotten, the longest unused first, when they have too many points together", () => {
    const known = new KnownScenes();
    const large = () => {
      const scene = sceneOf(1, [1]);
      return {
        ...scene,
        polylines: { ...scene.polylines, coordinates: { length: 3e6 } },
      } as unknown as Scene;
    };
    const scenes = [large(), large(), large()];
    scenes.slice(0, 2).forEach((scene, id) => {
      known.keep(id, scene);
    });
    known.get(0);
    known.keep(2, scenes[2] as Scene);
    expect([known.get(0), known.get(1), known.get(2)]).toEqual([scenes[0], null, scenes[2]]);
  });
});
