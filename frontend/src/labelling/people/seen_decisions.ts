/** Which of an image's decisions this page knows: what comes after them from others must not be overruled unseen. */
export class SeenDecisions {
  private readonly latest = new Map<number, number>();

  /** The id of the last decision of an image that is known here; null where nothing is. */
  of(imageId: number): number | null {
    return this.latest.get(imageId) ?? null;
  }

  /** The page shows all decisions up to this one; an earlier one says nothing new. */
  raise(imageId: number, decisionId: number): void {
    this.latest.set(imageId, Math.max(decisionId, this.latest.get(imageId) ?? 0));
  }
}
