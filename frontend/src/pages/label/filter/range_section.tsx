import { useMemo } from "react";
import { useRights } from "../../../api/use_rights";
import { Button } from "../../../design/button";
import { formatCount } from "../../../design/format";
import { isShown, type LabelState, type Shown } from "../../../labelling/label_state";
import {
  areLimited,
  MEASURES,
  type Measure,
  NO_RANGES,
  type Range,
  type Ranges,
  type Side,
  stopsFor,
} from "../../../labelling/ranges";
import { BeyondRow } from "./beyond_row";
import { RangeSlider } from "./range_slider";
import "./filter.css";

const NAMES: Readonly<Record<Measure, string>> = { length: "Length", score: "Score", residual: "Residual" };
const SIDES: readonly Side[] = ["low", "high"];

interface RangeSectionProps {
  state: LabelState;
  onShown: (shown: Shown) => void;
  /** Selects candidates, by index. */
  onSelect: (indices: readonly number[]) => void;
  onReject: (indices: readonly number[]) => void;
}

/** Which candidates are shown by what was measured of them; those beyond can be judged together. */
export function RangeSection({ state, onShown, onSelect, onReject }: RangeSectionProps) {
  const { candidates, shown } = state;
  const { label: judges } = useRights();
  const sliders = useMemo(
    () => MEASURES.map((measure) => [measure, stopsFor(measure, candidates)] as const),
    [candidates],
  );
  const limited = areLimited(shown.ranges);
  const setRanges = (ranges: Ranges) => onShown({ ...shown, ranges });
  return (
    <details className="panel-section range-section" open={limited || undefined}>
      <summary>
        <h2>Filter</h2>
        <span className="muted">
          {limited ? `${formatCount(shownCount(state))} shown` : "length, score, residual"}
        </span>
      </summary>
      {sliders.map(([measure, stops]) =>
        stops === null ? null : (
          <div key={measure} className="range-row">
            <RangeSlider
              label={NAMES[measure]}
              measure={measure}
              stops={stops}
              range={shown.ranges[measure]}
              onChange={(range: Range) => setRanges({ ...shown.ranges, [measure]: range })}
            />
            {SIDES.map((side) => (
              <BeyondRow
                key={side}
                state={state}
                measure={measure}
                side={side}
                judges={judges}
                onSelect={onSelect}
                onReject={onReject}
              />
            ))}
          </div>
        ),
      )}
      {limited ? (
        <Button small tone="quiet" className="range-section__reset" onClick={() => setRanges(NO_RANGES)}>
          Show all again
        </Button>
      ) : null}
    </details>
  );
}

function shownCount(state: LabelState): number {
  return state.sequence.filter((index) => isShown(state, index)).length;
}
