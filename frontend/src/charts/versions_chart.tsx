import { useRef, useState } from "react";
import { formatDay } from "../design/format";
import { fittedDomain, linearScale, type Scale, ticks } from "./scale";
import { useWidth } from "./use_width";
import "./charts.css";

interface Version {
  id: number;
  label: string;
  /** ms since 1970. */
  time: number;
  value: number;
  low: number | null;
  high: number | null;
}

interface VersionsChartProps {
  /** Oldest first. */
  points: readonly Version[];
  onOpen: (id: number) => void;
}

const USUAL_WIDTH = 720;
const HEIGHT = 200;
const LEFT = 44;
const RIGHT = 24;
const TOP = 12;
const BOTTOM = 30;

/** F1 of the versions of a method over time. */
export function VersionsChart({ points, onOpen }: VersionsChartProps) {
  const [current, setCurrent] = useState<number | null>(null);
  const figure = useRef<HTMLElement>(null);
  const width = useWidth(figure, USUAL_WIDTH);
  const times = points.map(({ time }) => time);
  const x = linearScale([Math.min(...times), Math.max(...times)], [LEFT + 16, width - RIGHT]);
  const y = linearScale(
    fittedDomain(
      points.flatMap(({ value, low, high }) => [value, low ?? value, high ?? value]),
      { step: 0.05, width: 0.1, limits: [0, 1] },
    ),
    [HEIGHT - BOTTOM, TOP],
  );
  const shown = points.find(({ id }) => id === current) ?? points.at(-1);
  return (
    <figure ref={figure} className="versions-chart">
      <svg viewBox={`0 0 ${width} ${HEIGHT}`} className="versions-chart__plot">
        <title>F1 over time</title>
        <Axes x={x} y={y} width={width} times={times} />
        <path
          className="versions-chart__line"
          d={`M${points.map(({ time, value }) => `${x.at(time).toFixed(1)} ${y.at(value).toFixed(1)}`).join("L")}`}
        />
        {points.map(({ id, label, time, value, low, high }) => (
          <a
            key={id}
            href={`/submissions/${id}`}
            className="scatter__point"
            aria-label={`${label}, ${formatDay(new Date(time).toISOString())}: F1 ${value.toFixed(3)}`}
            onFocus={() => setCurrent(id)}
            onPointerEnter={() => setCurrent(id)}
            onClick={(event) => {
              if (event.ctrlKey || event.metaKey || event.shiftKey) return;
              event.preventDefault();
              onOpen(id);
            }}
          >
            {low !== null && high !== null ? (
              <line
                className="versions-chart__interval"
                x1={x.at(time)}
                x2={x.at(time)}
                y1={y.at(low)}
                y2={y.at(high)}
              />
            ) : null}
            <circle className="scatter__reach" cx={x.at(time)} cy={y.at(value)} r={12} />
            <circle
              className="marker marker--method"
              cx={x.at(time)}
              cy={y.at(value)}
              r={id === shown?.id ? 6 : 4.5}
            />
          </a>
        ))}
      </svg>
      <figcaption className="scatter__caption">
        <span className="scatter__readout">
          {shown ? `${shown.label}: F1 ${shown.value.toFixed(3)}` : ""}
        </span>
      </figcaption>
    </figure>
  );
}

interface AxesProps {
  x: Scale;
  y: Scale;
  width: number;
  times: readonly number[];
}

function Axes({ x, y, width, times }: AxesProps) {
  const days = [Math.min(...times), Math.max(...times)];
  const names = days.map((time) => formatDay(new Date(time).toISOString()));
  return (
    <g className="chart-axes">
      {ticks(y.domain, 4).map((value) => (
        <g key={value}>
          <line x1={LEFT} x2={width - RIGHT + 12} y1={y.at(value)} y2={y.at(value)} />
          <text x={LEFT - 8} y={y.at(value)} textAnchor="end" dominantBaseline="central">
            {value}
          </text>
        </g>
      ))}
      {days.map((time, index) =>
        index === 1 && names[0] === names[1] ? null : (
          <text key={names[index]} x={x.at(time)} y={HEIGHT - 8} textAnchor={index === 0 ? "start" : "end"}>
            {names[index]}
          </text>
        ),
      )}
    </g>
  );
}
