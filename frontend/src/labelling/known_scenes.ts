/** The scenes of images that were open a moment ago: going back to one asks for its verdicts only, not for its points. */

import type { Scene } from "../canvas/scene";

/** Points together, about 16 bytes each with what is made of them: 64 MB. */
const MOST_POINTS = 4e6;

export class KnownScenes {
  /** The latest asked for is the last. */
  private readonly scenes = new Map<number, Scene>();

  get(imageId: number): Scene | null {
    const scene = this.scenes.get(imageId);
    if (scene === undefined) return null;
    this.scenes.delete(imageId);
    this.scenes.set(imageId, scene);
    return scene;
  }

  keep(imageId: number, scene: Scene): void {
    this.forget(imageId);
    this.scenes.set(imageId, scene);
    let points = 0;
    for (const [id, kept] of [...this.scenes].reverse()) {
      points += kept.polylines.coordinates.length / 2;
      if (points > MOST_POINTS && id !== imageId) this.forget(id);
    }
  }

  forget(imageId: number): void {
    this.scenes.delete(imageId);
  }
}
