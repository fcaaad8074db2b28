import { useQuery } from "@tanstack/react-query";
import { adviceQuery } from "../../../api/camera_endpoints";
import type { Grid } from "../../../api/camera_types";
import { asProblem } from "../../../api/problem";
import { CellMap } from "../../../charts/cell_map";
import { formatCount, formatQuantity, sentence } from "../../../design/format";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { AdviceSection } from "./advice_section";
import { DifferenceMap } from "./difference_map";
import { FreeModelMap } from "./free_model_map";
import "./maps.css";

/** What is known where in the frame. */
export function MapsPart({ camera, calibration }: PartProps) {
  const { result } = calibration;
  const { map, uncertainty } = result;
  const advice = useQuery(adviceQuery(calibration.id));
  const marks = (advice.data?.cells ?? []).map((cell) => ({
    column: cell.column,
    row: cell.row,
    label: `Five more lines here: ${px(cell.sigma_with)} instead of ${px(cell.sigma_now)}`,
  }));
  const covered = map.lines.flat().filter((length) => length !== null && length > 0).length;
  const cells = map.columns * map.rows;
  return (
    <div className="maps">
      <section className="section card" aria-labelledby="uncertainty-title">
        <div className="section__header">
          <h2 id="uncertainty-title">How far off the correction may be</h2>
          <p className="muted">
            The error at a place lies below this with 95 %, the best homography taken away
          </p>
        </div>
        <CellMap
          label="95 % bound of the error of the correction"
          frame={camera}
          grid={map}
          values={map.sigma}
          spacing="decades"
          unit="px, 95 % bound"
          text={(value) => `below ${px(value)} with 95 %`}
          marks={marks}
        />
        <p className="muted numeric">
          {px(uncertainty.pred)} RMS over the frame; worst {px(largest(map.sigma))} at a place.
        </p>
      </section>
      <section className="section card" aria-labelledby="coverage-title">
        <div className="section__header">
          <h2 id="coverage-title">Where lines lie</h2>
          <p className="muted">Length of the used lines in each cell; without lines the model extrapolates</p>
        </div>
        <CellMap
          label="Length of lines by cell"
          frame={camera}
          grid={map}
          values={map.lines}
          spacing="decades"
          unit="px of lines"
          nothing="no lines"
          text={(value) => (value > 0 ? `${formatCount(value)} px of lines` : "no lines")}
          marks={marks}
        />
        <p className="muted numeric">
          Lines in {formatCount(covered)} of {formatQuantity(cells, "cell")}.
        </p>
      </section>
      <section className="section card" aria-labelledby="shift-title">
        <div className="section__header">
          <h2 id="shift-title">How far the correction moves</h2>
          <p className="muted">From the measured to the corrected place</p>
        </div>
        <CellMap
          label="Length of the correction"
          frame={camera}
          grid={map}
          values={map.shift}
          spacing="even"
          unit="px"
          text={(value) => `moved by ${px(value)}`}
        />
        <p className="muted numeric">
          {px(uncertainty.correction)} RMS over the frame; most {px(largest(map.shift))}.
        </p>
      </section>
      <AdviceSection
        slug={camera.dataset.slug}
        advice={advice.data}
        failure={advice.isError ? sentence(asProblem(advice.error).message) : null}
      />
      {camera.reference ? <DifferenceMap camera={camera} calibration={calibration} /> : null}
      <FreeModelMap camera={camera} calibration={calibration} />
    </div>
  );
}

function largest(values: Grid): number {
  return Math.max(...values.flatMap((line) => line.map((value) => value ?? 0)));
}
