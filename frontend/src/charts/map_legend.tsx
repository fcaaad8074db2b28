import { colourOf, type Levels } from "./map_levels";

interface MapLegendProps {
  levels: Levels;
  unit: string;
  nothing?: string | undefined;
}

/** The colours of a map with the numbers at which they change. */
export function MapLegend({ levels, unit, nothing }: MapLegendProps) {
  const { breaks } = levels;
  const steps = Array.from({ length: breaks.length + 1 }, (_, level) => level);
  return (
    <div className="map-legend numeric">
      <ul aria-label={`Colours, ${unit}`}>
        {steps.map((level) => (
          <li key={level}>
            <span className={`map-legend__colour map-colour-${colourOf(level, levels)}`} aria-hidden="true" />
            <span className="visually-hidden">{stepText(breaks, level)}</span>
            {level > 0 ? (
              <span className="map-legend__limit" aria-hidden="true">
                {shown(breaks[level - 1])}
              </span>
            ) : null}
          </li>
        ))}
      </ul>
      <span className="muted">{unit}</span>
      {nothing ? (
        <span className="map-legend__nothing muted">
          <span className="map-legend__hatch" aria-hidden="true" /> {nothing}
        </span>
      ) : null}
    </div>
  );
}

function stepText(breaks: readonly number[], level: number): string {
  if (breaks.length === 0) return "everywhere the same";
  if (level === 0) return `below ${shown(breaks[0])}`;
  if (level === breaks.length) return `${shown(breaks.at(-1))} and more`;
  return `${shown(breaks[level - 1])} to ${shown(breaks[level])}`;
}

function shown(value: number | undefined): string {
  return value === undefined ? "" : String(Number(value.toPrecision(3)));
}
