import { type KeyboardEvent, type PointerEvent, useId, useMemo, useRef, useState } from "react";
import { CellTable } from "./cell_table";
import { type Cell, cellAt, cellEdges, cellIndex, type FrameSize, roundFactor } from "./frame_cells";
import { MapLegend } from "./map_legend";
import { colourOf, levelsOf, type Spacing } from "./map_levels";
import "./cell_map.css";

/** null where nothing is known, such as beyond a fold of a lens. */
type Grid = readonly (readonly (number | null)[])[];

export interface CellMapGrid {
  readonly x: readonly number[];
  readonly y: readonly number[];
}

export interface Arrows {
  /** px, row by row. */
  readonly dx: Grid;
  readonly dy: Grid;
}

interface CellMapProps {
  /** Accessible name. */
  label: string;
  frame: FrameSize;
  grid: CellMapGrid;
  values: Grid;
  spacing: Spacing;
  /** What the colours stand for: "px, 95 % bound". */
  unit: string;
  /** A value in words, as in the readout. */
  text: (value: number) => string;
  /** Cells with nothing in them are hatched; said in the legend. */
  nothing?: string;
  arrows?: Arrows;
  /** Cells that are pointed out, such as those where more lines help most. */
  marks?: readonly { readonly column: number; readonly row: number; readonly label: string }[];
  /** Values of another map that has the same colours for the same numbers. */
  alike?: Grid | undefined;
}

/** Length of an arrow that is among the longer ones, in cells; those in the corners may be several times as long. */
const REACH = 0.9;
const LONGER = 0.9;
/** More arrows than these in a row couldn't be told apart. */
const ARROWS_ACROSS = 16;

/** Values over the image's frame: colours in steps, a readout by pointer or arrow keys, and the numbers as a table. */
export function CellMap(props: CellMapProps) {
  const { label, frame, grid, values, spacing, unit, text, nothing, arrows, marks = [], alike } = props;
  const id = useId();
  const svg = useRef<SVGSVGElement>(null);
  const [pointed, setPointed] = useState<{ column: number; row: number } | null>(null);
  const levels = useMemo(
    () => levelsOf([...known(values), ...known(alike ?? [])], spacing),
    [values, alike, spacing],
  );
  const edges = useMemo(
    () => ({ x: cellEdges(grid.x, frame.width), y: cellEdges(grid.y, frame.height) }),
    [grid, frame.width, frame.height],
  );
  const columns = grid.x.length;
  const rows = grid.y.length;
  const told = pointed === null ? null : (values[pointed.row]?.[pointed.column] ?? null);
  const mark = marks.find(({ column, row }) => column === pointed?.column && row === pointed.row);

  const onPointerMove = (event: PointerEvent) => {
    const box = svg.current?.getBoundingClientRect();
    if (!box || box.width === 0) return;
    const x = ((event.clientX - box.left) / box.width) * frame.width - 0.5;
    const y = ((event.clientY - box.top) / box.height) * frame.height - 0.5;
    setPointed({ column: cellIndex(edges.x, x), row: cellIndex(edges.y, y) });
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const step = ARROW_STEPS[event.key];
    if (step === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const from = pointed ?? {
      column: Math.floor(columns / 2) - step[0],
      row: Math.floor(rows / 2) - step[1],
    };
    setPointed({
      column: Math.min(columns - 1, Math.max(0, from.column + step[0])),
      row: Math.min(rows - 1, Math.max(0, from.row + step[1])),
    });
  };

  return (
    <figure className="cell-map">
      <div
        className="cell-map__field"
        role="application"
        aria-label={`${label}, map of ${columns} by ${rows} cells; arrow keys read them`}
        aria-describedby={`${id}-readout`}
        // biome-ignore lint/a11y/noNoninteractiveTabindex: cells are read by arrow keys, as in an application region
        tabIndex={0}
        onKeyDown={onKeyDown}
        onPointerMove={onPointerMove}
        onPointerDown={onPointerMove}
        onPointerLeave={() => setPointed(null)}
        onBlur={() => setPointed(null)}
      >
        <svg
          ref={svg}
          className="cell-map__plot"
          viewBox={`-0.5 -0.5 ${frame.width} ${frame.height}`}
          aria-hidden="true"
        >
          <defs>
            <pattern
              id={`${id}-hatch`}
              width={frame.width / 90}
              height={frame.width / 90}
              patternUnits="userSpaceOnUse"
              patternTransform="rotate(45)"
            >
              <rect className="cell-map__hatch-ground" width="100%" height="100%" />
              <rect className="cell-map__hatch" width={frame.width / 300} height="100%" />
            </pattern>
          </defs>
          {values.map((line, row) =>
            line.map((value, column) => {
              const cell = cellAt(edges.x, edges.y, column, row);
              const empty = value === null || (nothing !== undefined && !(value > 0));
              return (
                <rect
                  // biome-ignore lint/suspicious/noArrayIndexKey: a cell is its place
                  key={`${column} ${row}`}
                  className={
                    empty ? "cell-map__nothing" : `map-colour-${colourOf(levels.of(value ?? 0), levels)}`
                  }
                  {...(empty ? { fill: `url(#${id}-hatch)` } : {})}
                  x={cell.left}
                  y={cell.top}
                  width={cell.width}
                  height={cell.height}
                />
              );
            }),
          )}
          {arrows ? <ArrowField grid={grid} frame={frame} arrows={arrows} /> : null}
          {marks.map(({ column, row, label: text }) => (
            <CellFrame key={text} className="cell-map__mark" cell={cellAt(edges.x, edges.y, column, row)} />
          ))}
          {pointed ? (
            <CellFrame
              className="cell-map__pointed"
              cell={cellAt(edges.x, edges.y, pointed.column, pointed.row)}
            />
          ) : null}
        </svg>
      </div>
      <figcaption className="cell-map__caption">
        <MapLegend levels={levels} unit={unit} nothing={nothing} />
        <p id={`${id}-readout`} className="cell-map__readout numeric" aria-live="polite">
          {pointed === null
            ? "Point at a cell, or use Tab and the arrow keys"
            : `${placeText(grid, pointed.column, pointed.row)}: ${told === null ? "not known" : text(told)}${mark ? `. ${mark.label}` : ""}`}
        </p>
        {arrows ? (
          <p className="muted">Arrows are {arrowFactor(grid, frame, arrows)} times as long as the shifts.</p>
        ) : null}
      </figcaption>
      <CellTable label={label} grid={grid} values={values} />
    </figure>
  );
}

const ARROW_STEPS: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

function known(values: Grid): number[] {
  return values.flatMap((line) => line.filter((value) => value !== null));
}

function placeText({ x, y }: CellMapGrid, column: number, row: number): string {
  return `Around (${Math.round(x[column] ?? 0)}, ${Math.round(y[row] ?? 0)})`;
}

function CellFrame({ cell, className }: { cell: Cell; className: string }) {
  return (
    <g className={className}>
      <rect x={cell.left} y={cell.top} width={cell.width} height={cell.height} />
      <rect x={cell.left} y={cell.top} width={cell.width} height={cell.height} />
    </g>
  );
}

function ArrowField({ grid, frame, arrows }: { grid: CellMapGrid; frame: FrameSize; arrows: Arrows }) {
  const factor = arrowFactor(grid, frame, arrows);
  const every = Math.max(1, Math.ceil(grid.x.length / ARROWS_ACROSS));
  const largest = frame.width / 160;
  const parts: string[] = [];
  for (let row = Math.floor((every - 1) / 2); row < grid.y.length; row += every) {
    for (let column = Math.floor((every - 1) / 2); column < grid.x.length; column += every) {
      const x = grid.x[column] ?? 0;
      const y = grid.y[row] ?? 0;
      const dx = factor * (arrows.dx[row]?.[column] ?? Number.NaN);
      const dy = factor * (arrows.dy[row]?.[column] ?? Number.NaN);
      const length = Math.hypot(dx, dy);
      // Shorter ones would be dots: there is nothing to see there.
      if (!(length > largest / 2)) continue;
      const head = Math.min(largest, length / 2);
      const [ux, uy] = [(head * dx) / length, (head * dy) / length];
      parts.push(
        `M${x} ${y}l${dx} ${dy}m${-ux - uy / 2} ${-uy + ux / 2}l${ux + uy / 2} ${uy - ux / 2}l${-ux + uy / 2} ${-uy - ux / 2}`,
      );
    }
  }
  const path = parts.join("");
  return (
    <g className="cell-map__arrows">
      <path d={path} />
      <path d={path} />
    </g>
  );
}

function arrowFactor(grid: CellMapGrid, frame: FrameSize, { dx, dy }: Arrows): number {
  const lengths = dx
    .flatMap((line, row) => line.map((x, column) => Math.hypot(x ?? 0, dy[row]?.[column] ?? 0)))
    .sort((a, b) => a - b);
  const long = lengths[Math.floor(LONGER * (lengths.length - 1))] ?? 0;
  const every = Math.max(1, Math.ceil(grid.x.length / ARROWS_ACROSS));
  return roundFactor((REACH * every * frame.width) / grid.x.length / long);
}
