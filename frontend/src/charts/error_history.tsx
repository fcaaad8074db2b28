import { useRef, useState } from "react";
import { formatDay } from "../design/format";
import { linearScale, ticks } from "./scale";
import { useWidth } from "./use_width";
import "./charts.css";
import "./error_history.css";

interface Entry {
  readonly id: number;
  /** ms since 1970. */
  readonly time: number;
  /** Expected error, px, and what it lies below with 95 %. */
  readonly value: number;
  readonly bound: number;
  readonly accepted: boolean;
}

interface ErrorHistoryProps {
  /** Oldest first. */
  points: readonly Entry[];
  current: number | null;
  onOpen: (id: number) => void;
}

const USUAL_WIDTH = 720;
const HEIGHT = 190;
const LEFT = 50;
const RIGHT = 22;
const TOP = 10;
const BOTTOM = 26;

/** Expected errors of a camera's calibrations, one after the other. */
export function ErrorHistory({ points, current, onOpen }: ErrorHistoryProps) {
  const figure = useRef<HTMLElement>(null);
  const width = useWidth(figure, USUAL_WIDTH);
  const [pointed, setPointed] = useState<number | null>(null);
  const most = Math.max(...points.map(({ bound }) => bound), 1e-6);
  // By turn and not by time: several of one hour would lie on each other.
  const x = linearScale([0, Math.max(1, points.length - 1)], [LEFT + 14, width - RIGHT]);
  const y = linearScale([0, 1.05 * most], [HEIGHT - BOTTOM, TOP]);
  const told = points.find(({ id }) => id === (pointed ?? current)) ?? points.at(-1);
  const line = points.map(({ value }, place) => `${x.at(place).toFixed(1)} ${y.at(value).toFixed(1)}`);
  return (
    <figure ref={figure} className="error-history">
      <svg viewBox={`0 0 ${width} ${HEIGHT}`} className="versions-chart__plot">
        <title>Expected error of the calibrations, px</title>
        <g className="chart-axes">
          {ticks([0, most], 4).map((value) => (
            <g key={value}>
              <line x1={LEFT} x2={width - RIGHT + 10} y1={y.at(value)} y2={y.at(value)} />
              <text x={LEFT - 8} y={y.at(value)} textAnchor="end" dominantBaseline="central">
                {value}
              </text>
            </g>
          ))}
          <text x={x.at(0)} y={HEIGHT - 6} textAnchor="start">
            {day(points[0])}
          </text>
          {points.length > 1 && day(points.at(-1)) !== day(points[0]) ? (
            <text x={x.at(points.length - 1)} y={HEIGHT - 6} textAnchor="end">
              {day(points.at(-1))}
            </text>
          ) : null}
          <text
            className="chart-axes__title"
            textAnchor="middle"
            transform={`translate(12 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`}
          >
            px RMS
          </text>
        </g>
        <path className="versions-chart__line" d={`M${line.join("L")}`} />
        {points.map(({ id, value, bound, accepted }, place) => (
          <a
            key={id}
            href={`?calibration=${id}`}
            className="scatter__point"
            aria-label={entryText({ id, value, bound, accepted })}
            onFocus={() => setPointed(id)}
            onBlur={() => setPointed(null)}
            onPointerEnter={() => setPointed(id)}
            onPointerLeave={() => setPointed(null)}
            onClick={(event) => {
              if (event.ctrlKey || event.metaKey || event.shiftKey) return;
              event.preventDefault();
              onOpen(id);
            }}
          >
            <line
              className="versions-chart__interval"
              x1={x.at(place)}
              x2={x.at(place)}
              y1={y.at(value)}
              y2={y.at(bound)}
            />
            <circle className="scatter__reach" cx={x.at(place)} cy={y.at(value)} r={12} />
            {accepted ? (
              <circle
                className="marker marker--method"
                cx={x.at(place)}
                cy={y.at(value)}
                r={id === told?.id ? 6.5 : 5}
              />
            ) : (
              <rect
                className="marker marker--baseline"
                x={x.at(place) - 4.5}
                y={y.at(value) - 4.5}
                width={9}
                height={9}
              />
            )}
          </a>
        ))}
      </svg>
      <figcaption className="scatter__caption">
        <span className="scatter__readout">{told ? entryText(told) : ""}</span>
      </figcaption>
    </figure>
  );
}

function day(entry: Entry | undefined): string {
  return entry === undefined ? "" : formatDay(new Date(entry.time).toISOString());
}

function entryText({ id, value, bound, accepted }: Omit<Entry, "time">): string {
  const verdict = accepted ? "accepted" : "refused";
  return `Calibration ${id}, ${verdict}: ${value.toFixed(2)} px, below ${bound.toFixed(2)} px with 95 %`;
}
