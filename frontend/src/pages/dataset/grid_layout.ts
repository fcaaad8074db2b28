/** Where tiles lie and which are in view. All tiles have one size, so that nothing moves while images load. */

export type GridSize = "small" | "large";

export interface GridLayout {
  columns: number;
  /** All in px. */
  tileWidth: number;
  mediaHeight: number;
  tileHeight: number;
  gap: number;
}

const SMALLEST_TILE: Record<GridSize, number> = { small: 168, large: 300 };
const CAPTION = 62;
const GAP = 12;

/** @param aspect width by height of a picture's place. */
export function gridLayout(width: number, size: GridSize, aspect: number): GridLayout {
  const columns = Math.max(1, Math.floor((width + GAP) / (SMALLEST_TILE[size] + GAP)));
  const tileWidth = Math.max(1, (width - GAP * (columns - 1)) / columns);
  const mediaHeight = Math.round(tileWidth / aspect);
  return { columns, tileWidth, mediaHeight, tileHeight: mediaHeight + CAPTION, gap: GAP };
}

export function gridHeight({ columns, tileHeight, gap }: GridLayout, count: number): number {
  const rows = Math.ceil(count / columns);
  return rows === 0 ? 0 : rows * (tileHeight + gap) - gap;
}

export function tilePlace({ columns, tileWidth, tileHeight, gap }: GridLayout, index: number) {
  return {
    left: (index % columns) * (tileWidth + gap),
    top: Math.floor(index / columns) * (tileHeight + gap),
  };
}

/**
 * Indices `[first, end)` of the tiles within reach.
 *
 * @param top of the view, relative to the grid's top, px; negative above it.
 * @param reach rows beyond the view on each side.
 */
export function tilesInView(layout: GridLayout, count: number, top: number, height: number, reach = 2) {
  const row = layout.tileHeight + layout.gap;
  const firstRow = Math.max(0, Math.floor(top / row) - reach);
  const endRow = Math.max(0, Math.ceil((top + height) / row) + reach);
  const first = Math.min(count, firstRow * layout.columns);
  return { first, end: Math.max(first, Math.min(count, endRow * layout.columns)) };
}

/** The tile that an arrow key leads to; null for other keys. */
export function tileAfterKey(key: string, index: number, columns: number, count: number): number | null {
  const steps: Record<string, number> = {
    ArrowRight: 1,
    ArrowLeft: -1,
    ArrowDown: columns,
    ArrowUp: -columns,
    PageDown: 3 * columns,
    PageUp: -3 * columns,
    Home: -index,
    End: count - 1 - index,
  };
  const step = steps[key];
  if (step === undefined || count === 0) return null;
  return Math.min(count - 1, Math.max(0, index + step));
}

/** Shape of the pictures' place: that of the middle image, within what a tile can show. */
export function commonAspect(images: readonly { width: number; height: number }[]): number {
  const aspects = images.map(({ width, height }) => width / height).sort((a, b) => a - b);
  const middle = aspects[Math.floor(aspects.length / 2)] ?? 4 / 3;
  return Math.min(2.4, Math.max(1.25, middle));
}
