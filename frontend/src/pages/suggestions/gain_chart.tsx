import { useRef, useState } from "react";
import { linearScale, ticks } from "../../charts/scale";
import { useWidth } from "../../charts/use_width";
import { type GainEntry, gainText } from "./gain";
import "../../charts/charts.css";

const USUAL_WIDTH = 640;
const HEIGHT = 240;
const LEFT = 46;
const RIGHT = 14;
const TOP = 12;
const BOTTOM = 40;
const MOST_TICKS = 10;

/** Keys per image in the order in which the images were finished: without suggestions, and with those of then. */
export function GainChart({ gain }: { gain: readonly GainEntry[] }) {
  const figure = useRef<HTMLElement>(null);
  const width = useWidth(figure, USUAL_WIDTH);
  const [current, setCurrent] = useState<number | null>(null);
  const most = Math.max(1, ...gain.flatMap(({ keys, keys_by_hand }) => [keys, keys_by_hand]));
  const x = linearScale([0.5, gain.length + 0.5], [LEFT, width - RIGHT]);
  const y = linearScale([0, 1.05 * most], [HEIGHT - BOTTOM, TOP]);
  const pointed = current === null ? undefined : gain[current];
  const step = (width - LEFT - RIGHT) / Math.max(1, gain.length);
  return (
    <figure ref={figure} className="scatter">
      <svg viewBox={`0 0 ${width} ${HEIGHT}`} className="scatter__plot">
        <title>Keys per image, with and without suggestions</title>
        <g className="chart-axes">
          {ticks([0, most], 5).map((value) => (
            <g key={value}>
              <line x1={LEFT} x2={width - RIGHT} y1={y.at(value)} y2={y.at(value)} />
              <text x={LEFT - 8} y={y.at(value)} textAnchor="end" dominantBaseline="central">
                {value}
              </text>
            </g>
          ))}
          {ticks([1, Math.max(2, gain.length)], Math.min(MOST_TICKS, gain.length))
            .filter((value) => Number.isInteger(value) && value <= gain.length)
            .map((value) => (
              <text key={value} x={x.at(value)} y={HEIGHT - BOTTOM + 16} textAnchor="middle">
                {value}
              </text>
            ))}
          <text
            className="chart-axes__title"
            x={(LEFT + width - RIGHT) / 2}
            y={HEIGHT - 6}
            textAnchor="middle"
          >
            Image, in the order in which they were finished
          </text>
          <text
            className="chart-axes__title"
            textAnchor="middle"
            transform={`translate(12 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`}
          >
            Keys
          </text>
        </g>
        {gain.map((entry, index) => (
          <g
            // biome-ignore lint/suspicious/noArrayIndexKey: the place is what an entry is
            key={index}
            onPointerEnter={() => setCurrent(index)}
            onPointerLeave={() => setCurrent(null)}
          >
            <rect
              className="scatter__reach"
              x={x.at(index + 1) - step / 2}
              y={TOP}
              width={step}
              height={HEIGHT - TOP - BOTTOM}
            />
            <line
              className="gain-chart__spared"
              x1={x.at(index + 1)}
              x2={x.at(index + 1)}
              y1={y.at(entry.keys)}
              y2={y.at(entry.keys_by_hand)}
            />
            <rect
              className="marker marker--baseline"
              x={x.at(index + 1) - 4}
              y={y.at(entry.keys_by_hand) - 4}
              width={8}
              height={8}
            />
            <circle className="marker marker--method" cx={x.at(index + 1)} cy={y.at(entry.keys)} r={5} />
          </g>
        ))}
      </svg>
      <figcaption className="scatter__caption">
        <span className="scatter__readout" aria-hidden="true">
          {pointed ? `Image ${(current ?? 0) + 1}: ${gainText(pointed)}` : "Point at an image"}
        </span>
        <span className="scatter__legend">
          <span>
            <svg width={14} height={14} aria-hidden="true" focusable="false">
              <rect className="marker marker--baseline" x={3} y={3} width={8} height={8} />
            </svg>
            by hand
          </span>
          <span>
            <svg width={14} height={14} aria-hidden="true" focusable="false">
              <circle className="marker marker--method" cx={7} cy={7} r={4.5} />
            </svg>
            with suggestions
          </span>
        </span>
      </figcaption>
    </figure>
  );
}
