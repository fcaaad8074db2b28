import { useQuery } from "@tanstack/react-query";
import { differenceQuery } from "../../../api/camera_endpoints";
import { ErrorState } from "../../../design/states";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { FieldMap } from "./field_map";

/** Where this lens and the camera's reference disagree. */
export function DifferenceMap({ camera, calibration }: PartProps) {
  const { data, isError, error, refetch } = useQuery(differenceQuery(calibration.id));
  const { uncertainty } = calibration.result;
  if (isError) return <ErrorState error={error} onRetry={() => refetch()} />;
  return (
    <section className="section card" aria-labelledby="difference-title">
      <div className="section__header">
        <h2 id="difference-title">Difference to the reference</h2>
        <p className="muted">From the reference to this lens, the best homography taken away</p>
      </div>
      {data ? (
        <>
          <FieldMap
            label="Difference to the reference"
            frame={camera}
            field={data}
            text={(length) => `this lens lies ${px(length)} from the reference`}
          />
          <dl className="difference__figures numeric">
            <div>
              <dt>RMS over the frame</dt>
              <dd>{px(data.rms)}</dd>
            </div>
            <div>
              <dt>Inner 80 %</dt>
              <dd>{px(data.inner_rms)}</dd>
            </div>
            <div>
              <dt>Most</dt>
              <dd>{px(data.maximum)}</dd>
            </div>
          </dl>
          <p className="muted numeric">
            {data.rms <= uncertainty.bound95
              ? `Within the 95 % bound of ${px(uncertainty.bound95)} that this calibration gives itself.`
              : `Beyond the 95 % bound of ${px(uncertainty.bound95)} that this calibration gives itself: one of the two is wrong, or the lens was changed in between.`}
          </p>
        </>
      ) : (
        <div className="skeleton maps__loading" role="status" aria-label="Loading the difference" />
      )}
    </section>
  );
}
