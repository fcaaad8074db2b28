import { useRef, useState } from "react";
import type { DatasetSuggestions } from "../../api/types";
import { linearScale, ticks } from "../../charts/scale";
import { useWidth } from "../../charts/use_width";
import { formatCount } from "../../design/format";
import "../../charts/charts.css";

type Bin = NonNullable<DatasetSuggestions["calibration"]>["bins"][number];
type KnownBin = Bin & { predicted: number; observed: number };

const USUAL_WIDTH = 420;
const HEIGHT = 320;
const LEFT = 60;
const RIGHT = 14;
const TOP = 12;
const BOTTOM = 42;

/** Share kept over the probability that was shown; on the diagonal a probability is what it says. */
export function ReliabilityDiagram({ bins }: { bins: readonly Bin[] }) {
  const figure = useRef<HTMLElement>(null);
  const width = useWidth(figure, USUAL_WIDTH);
  const [current, setCurrent] = useState<number | null>(null);
  const x = linearScale([0, 1], [LEFT, width - RIGHT]);
  const y = linearScale([0, 1], [HEIGHT - BOTTOM, TOP]);
  const shown = bins.filter((bin): bin is KnownBin => bin.predicted !== null && bin.observed !== null);
  const most = Math.max(1, ...shown.map(({ count }) => count));
  const pointed = shown.find(({ low }) => low === current);
  return (
    <figure ref={figure} className="scatter">
      <svg viewBox={`0 0 ${width} ${HEIGHT}`} className="scatter__plot">
        <title>Share kept over the probability</title>
        <g className="chart-axes">
          {ticks([0, 1], 5).map((value) => (
            <g key={value}>
              <line x1={x.at(value)} x2={x.at(value)} y1={TOP} y2={HEIGHT - BOTTOM} />
              <line x1={LEFT} x2={width - RIGHT} y1={y.at(value)} y2={y.at(value)} />
              <text x={x.at(value)} y={HEIGHT - BOTTOM + 16} textAnchor="middle">
                {percent(value)}
              </text>
              <text x={LEFT - 8} y={y.at(value)} textAnchor="end" dominantBaseline="central">
                {percent(value)}
              </text>
            </g>
          ))}
          <text
            className="chart-axes__title"
            x={(LEFT + width - RIGHT) / 2}
            y={HEIGHT - 6}
            textAnchor="middle"
          >
            Suggested probability
          </text>
          <text
            className="chart-axes__title"
            textAnchor="middle"
            transform={`translate(12 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`}
          >
            Kept by people
          </text>
        </g>
        <line className="reliability__ideal" x1={x.at(0)} y1={y.at(0)} x2={x.at(1)} y2={y.at(1)} />
        {shown.map((bin) => (
          <g key={bin.low} onPointerEnter={() => setCurrent(bin.low)} onPointerLeave={() => setCurrent(null)}>
            {bin.observed_low !== null && bin.observed_high !== null ? (
              <line
                className="reliability__interval"
                x1={x.at(bin.predicted)}
                x2={x.at(bin.predicted)}
                y1={y.at(bin.observed_low)}
                y2={y.at(bin.observed_high)}
              />
            ) : null}
            <circle className="scatter__reach" cx={x.at(bin.predicted)} cy={y.at(bin.observed)} r={14} />
            <circle
              className="marker marker--method"
              cx={x.at(bin.predicted)}
              cy={y.at(bin.observed)}
              r={3.5 + 6 * Math.sqrt(bin.count / most)}
            />
          </g>
        ))}
      </svg>
      <figcaption className="scatter__caption">
        <span className="scatter__readout" aria-hidden="true">
          {pointed ? binText(pointed) : "The larger a dot, the more candidates; bars are 95 % intervals"}
        </span>
        <span className="visually-hidden">{shown.map(binText).join("; ")}</span>
      </figcaption>
    </figure>
  );
}

function binText({ low, high, count, predicted, observed }: KnownBin): string {
  const range = `${Math.round(100 * low)} to ${percent(high)}`;
  return `${range}: ${formatCount(count)} candidates, ${percent(predicted)} suggested, ${percent(observed)} kept`;
}

function percent(share: number): string {
  return `${Math.round(100 * share)} %`;
}
