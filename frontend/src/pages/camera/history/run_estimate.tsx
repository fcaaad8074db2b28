import { Link } from "react-router";
import type { CameraDetail } from "../../../api/camera_types";
import { formatCount } from "../../../design/format";
import { readEstimate } from "../../dataset/lens";
import { px } from "../length_text";

/** What the newest pre-labelling run made of the raw candidates, to hold against the calibrations. */
export function RunEstimate({ camera }: { camera: CameraDetail }) {
  const estimate = readEstimate(camera.estimate);
  if (estimate === null) return null;
  const { accepted, predictedError, correction, trusted, k } = estimate;
  return (
    <section className="section card" aria-labelledby="run-estimate-title">
      <div className="section__header">
        <h2 id="run-estimate-title">Estimate of the newest run</h2>
        <Link to={`/datasets/${camera.dataset.slug}?tab=runs`}>Runs</Link>
      </div>
      <p className="numeric">
        {accepted ? "Accepted" : "Refused"}, from raw candidates that nobody judged
        {trusted === null ? "" : ` (${formatCount(trusted)} trusted)`}: predicted error {px(predictedError)},
        correction {px(correction)}, k = {k.map((value) => value.toFixed(4).replace(/^-/, "−")).join(", ")}.
      </p>
    </section>
  );
}
