import type { ScoringCase } from "./cases";

const WIDTH = 260;
const HEIGHT = 150;
const MARGIN = 14;
/** How far on each side of a label is near, px of the image. */
const NEAR = 3;

/** A label with the band in which a prediction counts as near, and predictions on it: whole ones are found. */
export function CasePicture({ shown }: { shown: ScoringCase }) {
  const { labels, predictions, found, ambiguous } = shown;
  const all = [...labels, ...predictions].flat();
  const xs = all.map(([x = 0]) => x);
  const ys = all.map(([, y = 0]) => y);
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const [width, height] = [Math.max(...xs) - left, Math.max(...ys) - top];
  const scale = Math.min(
    (WIDTH - 2 * MARGIN) / Math.max(1, width),
    (HEIGHT - 2 * MARGIN) / Math.max(1, height),
  );
  const startX = (WIDTH - scale * width) / 2;
  const startY = (HEIGHT - scale * height) / 2;
  const path = (line: readonly number[][]) =>
    line.map(([x = 0, y = 0]) => `${startX + scale * (x - left)},${startY + scale * (y - top)}`).join(" ");
  return (
    <svg className="case__picture" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} aria-hidden="true" focusable="false">
      {labels.map((line) => (
        <g key={path(line)} className={ambiguous ? "case__label case__label--ambiguous" : "case__label"}>
          <polyline className="case__band" points={path(line)} strokeWidth={2 * NEAR * scale} />
          <polyline className="case__line" points={path(line)} />
        </g>
      ))}
      {predictions.map((line, index) => (
        <polyline
          key={path(line)}
          className={`case__prediction ${ambiguous ? "case__prediction--ignored" : found[index] ? "case__prediction--found" : "case__prediction--wrong"}`}
          points={path(line)}
        />
      ))}
    </svg>
  );
}
