import type { CSSProperties } from "react";
import { endAt, type Measure, placeOf, type Range, type Side, type Stops } from "../../../labelling/ranges";
import { endText } from "./end_text";

interface RangeSliderProps {
  label: string;
  measure: Measure;
  stops: Stops;
  range: Range;
  onChange: (range: Range) => void;
}

/** A slider with two ends; pushed to its outer end, one means nothing is left out on that side. */
export function RangeSlider({ label, measure, stops, range, onChange }: RangeSliderProps) {
  const low = placeOf(range.low, "low", stops);
  const high = placeOf(range.high, "high", stops);
  const last = Math.max(1, stops.length - 1);

  function move(side: Side, place: number): void {
    const bounded = side === "low" ? Math.min(place, high) : Math.max(place, low);
    onChange({ ...range, [side]: endAt(bounded, side, stops) });
  }

  return (
    <fieldset className="range-slider">
      <legend>{label}</legend>
      <span
        className="range-slider__track"
        style={{ "--low": low / last, "--high": high / last } as CSSProperties}
      >
        <End
          side="low"
          name={`${label} from`}
          measure={measure}
          place={low}
          last={last}
          range={range}
          onMove={move}
        />
        <End
          side="high"
          name={`${label} to`}
          measure={measure}
          place={high}
          last={last}
          range={range}
          onMove={move}
        />
      </span>
      <span className="range-slider__text numeric">{rangeText(measure, range)}</span>
    </fieldset>
  );
}

interface EndProps {
  side: Side;
  name: string;
  measure: Measure;
  place: number;
  last: number;
  range: Range;
  onMove: (side: Side, place: number) => void;
}

function End({ side, name, measure, place, last, range, onMove }: EndProps) {
  const end = range[side];
  return (
    <input
      type="range"
      min={0}
      max={last}
      step={1}
      value={place}
      aria-label={name}
      aria-valuetext={end === null ? "no limit" : endText(measure, end)}
      onChange={(event) => onMove(side, event.currentTarget.valueAsNumber)}
    />
  );
}

function rangeText(measure: Measure, { low, high }: Range): string {
  if (low === null && high === null) return "all";
  if (high === null) return `≥ ${endText(measure, low ?? 0)}`;
  if (low === null) return `≤ ${endText(measure, high)}`;
  return `${endText(measure, low).replace(" px", "")}–${endText(measure, high)}`;
}
