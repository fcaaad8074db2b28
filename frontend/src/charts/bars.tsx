import { useRef, useState } from "react";
import { formatCount } from "../design/format";
import { linearScale, ticks } from "./scale";
import { useWidth } from "./use_width";
import "./charts.css";

export interface Bar {
  /** Below the bar, where there is room. */
  readonly label: string;
  /** In the readout: what the bar stands for in whole words. */
  readonly name: string;
  readonly value: number;
}

interface BarsProps {
  /** Accessible name. */
  label: string;
  bars: readonly Bar[];
  /** What is counted, in the plural. */
  unit: string;
  height?: number;
}

const LEFT = 44;
const BOTTOM = 20;
const TOP = 8;
/** A single bar as wide as the chart would look like a wall. */
const WIDEST = 56;
const NARROWEST_LABEL = 46;

/** Counts side by side; the one pointed at is told in words. */
export function Bars({ label, bars, unit, height = 150 }: BarsProps) {
  const frame = useRef<HTMLDivElement>(null);
  const width = useWidth(frame, 600);
  const [pointed, setPointed] = useState<number | null>(null);
  const most = Math.max(1, ...bars.map((bar) => bar.value));
  const marks = ticks([0, most], 3).filter(Number.isInteger);
  const y = linearScale([0, most], [height - BOTTOM, TOP]);
  const step = (width - LEFT) / Math.max(bars.length, 1);
  const wide = Math.max(1, Math.min(WIDEST, 0.86 * step));
  const every = Math.max(1, Math.ceil(NARROWEST_LABEL / step));
  const told = pointed === null ? undefined : bars[pointed];
  return (
    <div ref={frame} className="bars">
      <svg width={width} height={height} role="img" aria-label={`${label}: ${inWords(bars, unit)}`}>
        <g className="chart-axes">
          {marks.map((mark) => (
            <g key={mark}>
              <line x1={LEFT} x2={width} y1={y.at(mark)} y2={y.at(mark)} />
              <text x={LEFT - 6} y={y.at(mark) + 4} textAnchor="end">
                {formatCount(mark)}
              </text>
            </g>
          ))}
          {bars.map((bar, index) =>
            index % every === 0 ? (
              <text key={bar.name} x={LEFT + (index + 0.5) * step} y={height - 5} textAnchor="middle">
                {bar.label}
              </text>
            ) : null,
          )}
        </g>
        {bars.map((bar, index) => (
          <g
            key={bar.name}
            onPointerEnter={() => setPointed(index)}
            onPointerLeave={() => setPointed(null)}
            className={index === pointed ? "bars__bar bars__bar--pointed" : "bars__bar"}
          >
            <rect
              className="bars__reach"
              x={LEFT + index * step}
              y={TOP}
              width={step}
              height={height - BOTTOM - TOP}
            />
            <rect
              className="bars__fill"
              x={LEFT + (index + 0.5) * step - wide / 2}
              y={y.at(bar.value)}
              width={wide}
              height={y.at(0) - y.at(bar.value)}
            />
          </g>
        ))}
      </svg>
      <p className="bars__readout numeric" aria-hidden="true">
        {told === undefined ? "\u00a0" : `${told.name}: ${formatCount(told.value)} ${unit}`}
      </p>
    </div>
  );
}

function inWords(bars: readonly Bar[], unit: string): string {
  const some = bars.filter((bar) => bar.value > 0);
  if (some.length === 0) return `no ${unit}`;
  const total = some.reduce((sum, bar) => sum + bar.value, 0);
  const [top] = [...some].sort((a, b) => b.value - a.value);
  return `${formatCount(total)} ${unit}, most at ${top?.name}: ${formatCount(top?.value ?? 0)}`;
}
