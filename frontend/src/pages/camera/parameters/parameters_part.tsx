import { formatCount } from "../../../design/format";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { CorrelationMatrix } from "./correlation_matrix";
import { FocalSection } from "./focal_section";
import { ImagesTable } from "./images_table";
import { LadderTable } from "./ladder_table";
import { ParameterTable } from "./parameter_table";
import "./parameters.css";

/** The numbers of a lens, how well each is known, and how the model was chosen. */
export function ParametersPart({ camera, calibration }: PartProps) {
  const { result } = calibration;
  const { uncertainty, counts } = result;
  const facts: [string, string, string][] = [
    ["Expected error", px(uncertainty.pred), "RMS over the frame, the best homography taken away"],
    ["95 % bound", px(uncertainty.bound95), "The RMS error lies below it with 95 %"],
    [
      "Without single images",
      px(uncertainty.jackknife),
      "Spread of the lenses that one gets leaving out each image in turn",
    ],
    ["Noise of a point", px(result.noise), "Standard deviation across its line"],
    [
      "Effective lines",
      uncertainty.effective_lines.toFixed(0),
      "So many independent lines would tell as much: points of one line, and lines of one edge, repeat each other",
    ],
    ["Points", formatCount(counts.points), "Used in all"],
  ];
  return (
    <div className="parameters">
      <section className="section card parameters__wide" aria-labelledby="parameters-title">
        <div className="section__header">
          <h2 id="parameters-title">Parameters</h2>
          <p className="muted">For lengths in half diagonals from the image centre; ± is one sigma</p>
        </div>
        <ParameterTable result={result} />
      </section>
      <section className="section card" aria-labelledby="quality-title">
        <h2 id="quality-title">How well the lens is known</h2>
        <dl className="parameters__facts">
          {facts.map(([name, value, hint]) => (
            <div key={name}>
              <dt>{name}</dt>
              <dd className="numeric">{value}</dd>
              <dd className="muted">{hint}</dd>
            </div>
          ))}
        </dl>
      </section>
      <CorrelationMatrix released={result.released} correlation={result.correlation} />
      <FocalSection result={result} />
      <LadderTable result={result} />
      <ImagesTable camera={camera} calibration={calibration} />
    </div>
  );
}
