import { linearScale } from "./scale";
import "./charts.css";

const HEIGHT = 16;
const MARGIN = 5;

interface IntervalBarProps {
  value: number;
  low: number | null;
  high: number | null;
  domain: readonly [number, number];
  width?: number;
  /** Not one of those that are ranked. */
  aside?: boolean;
}

/** A value on its interval as a small picture; the numbers stand beside it, so it has no name of its own. */
export function IntervalBar({ value, low, high, domain, width = 120, aside }: IntervalBarProps) {
  const scale = linearScale(domain, [MARGIN, width - MARGIN]);
  const middle = HEIGHT / 2;
  return (
    <svg
      className={`interval-bar${aside ? " interval-bar--aside" : ""}`}
      width={width}
      height={HEIGHT}
      aria-hidden="true"
      focusable="false"
    >
      <line className="interval-bar__axis" x1={MARGIN} x2={width - MARGIN} y1={middle} y2={middle} />
      {low !== null && high !== null ? (
        <rect
          className="interval-bar__interval"
          x={scale.at(low)}
          width={Math.max(1, scale.at(high) - scale.at(low))}
          y={middle - 4}
          height={8}
          rx={2}
        />
      ) : null}
      <rect
        className="interval-bar__value"
        x={scale.at(value) - 1.25}
        y={1.5}
        width={2.5}
        height={HEIGHT - 3}
        rx={1}
      />
    </svg>
  );
}
