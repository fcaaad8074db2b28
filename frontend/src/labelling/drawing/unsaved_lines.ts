/** Points of lines that were left unsaved on their images, as long as this tab lives. */

import type { Point } from "../../canvas/geometry";

export class UnsavedLines {
  private readonly clicks = new Map<number, readonly Point[]>();

  /** Notes the points of an image's line that is being left; less than two make no line. */
  leave(imageId: number, clicks: readonly Point[]): void {
    if (clicks.length > 1) this.clicks.set(imageId, clicks);
  }

  /** Gives the points of the line that was left on an image, once. */
  take(imageId: number): readonly Point[] {
    const left = this.clicks.get(imageId) ?? [];
    this.clicks.delete(imageId);
    return left;
  }
}

/** The page's one. */
export const unsavedLines = new UnsavedLines();
