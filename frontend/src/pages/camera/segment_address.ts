/** Where a line is looked at in its image: the label page, with the line selected. */
export function segmentAddress(slug: string, imageId: number, segmentId: number): string {
  return `/datasets/${slug}/images/${imageId}?segment=${segmentId}`;
}
