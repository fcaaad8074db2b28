/** Brown-Conrady lenses as the server gives them, in the undistort direction: corrected = f(measured). */

export interface Lens {
  width: number;
  height: number;
  /** Distortion centre, px. */
  center: [number, number];
  /** Length that coordinates are divided by, px. */
  scale: number;
  k: number[];
  p: number[];
}

export interface LensEstimate extends Lens {
  accepted: boolean;
  reasons: string[];
  /** Predicted error of the correction, and the size of the correction itself, px RMS over the frame. */
  predictedError: number | null;
  correction: number | null;
  trusted: number | null;
}

export type Point = [number, number];

/** An estimate out of the JSON of the API; null where it isn't one. */
export function readEstimate(fields: Record<string, unknown> | null): LensEstimate | null {
  if (fields === null) return null;
  const { width, height, scale } = fields;
  const center = numbers(fields.center);
  if (typeof width !== "number" || typeof height !== "number" || typeof scale !== "number") return null;
  if (center.length !== 2 || scale <= 0) return null;
  const uncertainty = (fields.uncertainty ?? {}) as Record<string, unknown>;
  const counts = (fields.counts ?? {}) as Record<string, unknown>;
  return {
    width,
    height,
    scale,
    center: [center[0] ?? 0, center[1] ?? 0],
    k: numbers(fields.k),
    p: numbers(fields.p),
    accepted: fields.accepted === true,
    reasons: Array.isArray(fields.reasons) ? fields.reasons.map(String) : [],
    predictedError: numberOrNull(uncertainty.pred),
    correction: numberOrNull(uncertainty.correction),
    trusted: numberOrNull(counts.trusted),
  };
}

/** Where a measured pixel lies once the lens is taken out, px. Formula: Brown 1971. */
export function undistort(lens: Lens, [u, v]: Point): Point {
  const [k1 = 0, k2 = 0, k3 = 0] = lens.k;
  const [p1 = 0, p2 = 0] = lens.p;
  const x = (u - lens.center[0]) / lens.scale;
  const y = (v - lens.center[1]) / lens.scale;
  const r2 = x * x + y * y;
  const radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const cross = 2 * x * y;
  return [
    lens.center[0] + lens.scale * (x * radial + p1 * cross + p2 * (r2 + 2 * x * x)),
    lens.center[1] + lens.scale * (y * radial + p1 * (r2 + 2 * y * y) + p2 * cross),
  ];
}

/** Lines of an even grid over the frame, each a list of points, px. */
export function gridLines(lens: Lens, cells: number, steps = 32): Point[][] {
  const right = lens.width - 1;
  const bottom = lens.height - 1;
  const rows = Math.max(2, Math.round((cells * lens.height) / lens.width));
  const along = (at: (t: number) => Point) =>
    Array.from({ length: steps + 1 }, (_, step) => at(step / steps));
  const columns = Array.from({ length: cells + 1 }, (_, i) =>
    along((t): Point => [(right * i) / cells, bottom * t]),
  );
  const lines = Array.from({ length: rows + 1 }, (_, j) =>
    along((t): Point => [right * t, (bottom * j) / rows]),
  );
  return [...columns, ...lines];
}

/** How far the correction moves the pixels of the frame at most, px. */
export function largestShift(lens: Lens): number {
  const shifts = gridLines(lens, 8)
    .flat()
    .map((point) => {
      const [x, y] = undistort(lens, point);
      return Math.hypot(x - point[0], y - point[1]);
    });
  return Math.max(...shifts);
}

function numbers(value: unknown): number[] {
  return Array.isArray(value) ? value.filter((entry): entry is number => typeof entry === "number") : [];
}

function numberOrNull(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}
