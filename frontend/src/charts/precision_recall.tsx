import { type KeyboardEvent, useMemo, useRef } from "react";
import type { Measured, MethodKind } from "../api/board_types";
import { isoF1, isoF1Levels, type Point } from "./iso_f1";
import { Marker, MarkerKey } from "./marker";
import { placeLabels } from "./place_labels";
import { fittedDomain, linearScale, type Scale, ticks } from "./scale";
import { useWidth } from "./use_width";
import "./charts.css";

export interface ScatterPoint {
  id: string;
  name: string;
  kind: MethodKind;
  precision: Measured;
  recall: Measured;
  f1: number | null;
  /** Where a press leads. */
  href: string;
}

interface PrecisionRecallProps {
  points: readonly ScatterPoint[];
  highlighted: string | null;
  onHighlight: (id: string | null) => void;
  onOpen: (href: string) => void;
}

const USUAL_WIDTH = 560;
const HEIGHT = 420;
const LEFT = 46;
const RIGHT = 14;
const TOP = 14;
const BOTTOM = 40;
const KINDS: Record<MethodKind, string> = { method: "Method", baseline: "Baseline", ceiling: "Ceiling" };

/** Precision over recall with curves of equal F1. Arrow keys walk from point to point, Enter opens one. */
export function PrecisionRecall({ points, highlighted, onHighlight, onOpen }: PrecisionRecallProps) {
  const root = useRef<SVGSVGElement>(null);
  const figure = useRef<HTMLElement>(null);
  const width = useWidth(figure, USUAL_WIDTH);
  const shown = useMemo(() => points.filter(isPlaced), [points]);
  const [x, y] = useMemo(() => axes(shown, width), [shown, width]);
  const places = shown.map((point) => ({
    id: point.id,
    text: shortened(point.name),
    x: x.at(point.recall.value ?? 0),
    y: y.at(point.precision.value ?? 0),
  }));
  const labels = placeLabels(places, [LEFT, width]);
  const current = shown.find(({ id }) => id === highlighted);

  const onKeyDown = (event: KeyboardEvent) => {
    const index = shown.findIndex(({ id }) => id === highlighted);
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const next = shown[(index + step + shown.length) % shown.length];
    root.current?.querySelector<SVGElement>(`[data-id="${CSS.escape(next?.id ?? "")}"]`)?.focus();
  };

  return (
    <figure ref={figure} className="scatter">
      <svg ref={root} viewBox={`0 0 ${width} ${HEIGHT}`} onKeyDown={onKeyDown} className="scatter__plot">
        <title>Precision over recall</title>
        <Axes x={x} y={y} width={width} />
        <IsoCurves x={x} y={y} />
        {current ? <Cross point={current} x={x} y={y} /> : null}
        {labels.map((label) => (
          <text
            key={label.id}
            className={`scatter__name${label.id === highlighted ? " scatter__name--current" : ""}`}
            x={label.x}
            y={label.y}
            textAnchor={label.anchor}
            dominantBaseline="central"
          >
            {label.text}
          </text>
        ))}
        {shown.map((point) => (
          <a
            key={point.id}
            data-id={point.id}
            href={point.href}
            className="scatter__point"
            tabIndex={point.id === (current?.id ?? shown[0]?.id) ? 0 : -1}
            aria-label={pointText(point)}
            onFocus={() => onHighlight(point.id)}
            onBlur={() => onHighlight(null)}
            onPointerEnter={() => onHighlight(point.id)}
            onPointerLeave={() => onHighlight(null)}
            onClick={(event) => {
              if (event.ctrlKey || event.metaKey || event.shiftKey) return;
              event.preventDefault();
              onOpen(point.href);
            }}
          >
            <circle
              className="scatter__reach"
              cx={x.at(point.recall.value ?? 0)}
              cy={y.at(point.precision.value ?? 0)}
              r={13}
            />
            <Marker
              kind={point.kind}
              x={x.at(point.recall.value ?? 0)}
              y={y.at(point.precision.value ?? 0)}
              size={point.id === highlighted ? 6.5 : 5}
            />
          </a>
        ))}
      </svg>
      <figcaption className="scatter__caption">
        <span className="scatter__readout" aria-hidden="true">
          {current ? pointText(current) : "Point at a mark, or use Tab and the arrow keys"}
        </span>
        <span className="scatter__legend">
          {(["method", "baseline", "ceiling"] as const)
            .filter((kind) => shown.some((point) => point.kind === kind))
            .map((kind) => (
              <span key={kind}>
                <MarkerKey kind={kind} /> {KINDS[kind]}
              </span>
            ))}
          <span>
            <svg width={18} height={10} aria-hidden="true" focusable="false">
              <path className="scatter__iso" d="M1 2Q8 3 17 8" />
            </svg>
            equal F1
          </span>
        </span>
      </figcaption>
    </figure>
  );
}

function axes(points: readonly ScatterPoint[], width: number): [Scale, Scale] {
  const fit = { step: 0.1, width: 0.3, limits: [0, 1] as const };
  const ends = (measured: Measured) => [measured.value, measured.low, measured.high].flatMap((v) => v ?? []);
  const recall = fittedDomain(
    points.flatMap((point) => ends(point.recall)),
    fit,
  );
  const precision = fittedDomain(
    points.flatMap((point) => ends(point.precision)),
    fit,
  );
  return [linearScale(recall, [LEFT, width - RIGHT]), linearScale(precision, [HEIGHT - BOTTOM, TOP])];
}

function Axes({ x, y, width }: { x: Scale; y: Scale; width: number }) {
  return (
    <g className="chart-axes">
      {ticks(x.domain, 6).map((value) => (
        <g key={value}>
          <line x1={x.at(value)} x2={x.at(value)} y1={TOP} y2={HEIGHT - BOTTOM} />
          <text x={x.at(value)} y={HEIGHT - BOTTOM + 16} textAnchor="middle">
            {value}
          </text>
        </g>
      ))}
      {ticks(y.domain, 6).map((value) => (
        <g key={value}>
          <line x1={LEFT} x2={width - RIGHT} y1={y.at(value)} y2={y.at(value)} />
          <text x={LEFT - 8} y={y.at(value)} textAnchor="end" dominantBaseline="central">
            {value}
          </text>
        </g>
      ))}
      <text className="chart-axes__title" x={(LEFT + width - RIGHT) / 2} y={HEIGHT - 6} textAnchor="middle">
        Recall
      </text>
      <text
        className="chart-axes__title"
        textAnchor="middle"
        transform={`translate(12 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`}
      >
        Precision
      </text>
    </g>
  );
}

/** All names come after all curves: no curve runs through the name of another. */
function IsoCurves({ x, y }: { x: Scale; y: Scale }) {
  const curves = isoF1Levels(x.domain, y.domain)
    .map((f1) => ({ f1, curve: isoF1(f1, x.domain, y.domain).map(([r, p]): Point => [x.at(r), y.at(p)]) }))
    .filter(({ curve }) => curve.length > 0);
  return (
    <>
      {curves.map(({ f1, curve }) => (
        <path
          key={f1}
          className="scatter__iso"
          d={`M${curve.map(([a, b]) => `${fixed(a)} ${fixed(b)}`).join("L")}`}
        />
      ))}
      {curves.map(({ f1, curve }) => {
        const [labelX, labelY] = curve.at(-1) ?? [0, 0];
        return (
          <text key={f1} className="scatter__iso-name" x={labelX - 3} y={labelY - 5} textAnchor="end">
            {f1}
          </text>
        );
      })}
    </>
  );
}

/** The intervals of both numbers of a point. */
function Cross({ point, x, y }: { point: ScatterPoint; x: Scale; y: Scale }) {
  const { precision, recall } = point;
  const centre = [x.at(recall.value ?? 0), y.at(precision.value ?? 0)] as const;
  return (
    <g className="scatter__cross">
      {recall.low !== null && recall.high !== null ? (
        <line x1={x.at(recall.low)} x2={x.at(recall.high)} y1={centre[1]} y2={centre[1]} />
      ) : null}
      {precision.low !== null && precision.high !== null ? (
        <line x1={centre[0]} x2={centre[0]} y1={y.at(precision.low)} y2={y.at(precision.high)} />
      ) : null}
    </g>
  );
}

function isPlaced(point: ScatterPoint): boolean {
  return point.precision.value !== null && point.recall.value !== null;
}

function pointText({ name, kind, precision, recall, f1 }: ScatterPoint): string {
  const numbers = [
    ["precision", precision.value],
    ["recall", recall.value],
    ["F1", f1],
  ] as const;
  const text = numbers.flatMap(([what, value]) => (value === null ? [] : [`${what} ${value.toFixed(3)}`]));
  return `${name}${kind === "method" ? "" : ` (${kind})`}: ${text.join(", ")}`;
}

function shortened(name: string): string {
  return name.length > 24 ? `${name.slice(0, 22)}…` : name;
}

function fixed(value: number): string {
  return value.toFixed(1);
}
