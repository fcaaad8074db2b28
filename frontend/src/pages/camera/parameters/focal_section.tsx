import type { CalibrationResult } from "../../../api/camera_types";
import { formatQuantity, sentence } from "../../../design/format";
import { Note } from "../../note";
import { digits, px } from "../length_text";

/** Focal length and principal point, where the images tell them; else why they don't. */
export function FocalSection({ result }: { result: CalibrationResult }) {
  const { focal, width } = result;
  return (
    <section className="section card" aria-labelledby="focal-title">
      <div className="section__header">
        <h2 id="focal-title">Focal length</h2>
        <p className="muted">From vanishing points of the corrected lines, for square pixels</p>
      </div>
      {focal?.observable && focal.focal_length !== null ? (
        <>
          <dl className="parameters__facts">
            <div>
              <dt>Focal length</dt>
              <dd className="numeric">
                {digits(focal.focal_length)} ± {px(focal.sigma)}
              </dd>
              <dd className="muted numeric">
                {((2 * Math.atan(width / 2 / focal.focal_length) * 180) / Math.PI).toFixed(1)}° across the
                width
              </dd>
            </div>
            {focal.principal_point ? (
              <div>
                <dt>Principal point</dt>
                <dd className="numeric">
                  {digits(focal.principal_point[0])}, {digits(focal.principal_point[1])}
                  {focal.principal_point_sigma
                    ? ` ± ${digits(focal.principal_point_sigma[0])}, ${px(focal.principal_point_sigma[1])}`
                    : " px"}
                </dd>
                <dd className="muted">
                  {focal.principal_point_sigma
                    ? "From the images"
                    : "Taken to be where it is: these images don't tell it"}
                </dd>
              </div>
            ) : null}
          </dl>
          <p className="muted numeric">
            Told by {formatQuantity(focal.images, "image")} with{" "}
            {formatQuantity(focal.vanishing_points.length, "vanishing point")}.
          </p>
        </>
      ) : (
        <Note>
          Not observable from these images.{" "}
          {focal?.reason
            ? sentence(focal.reason)
            : "It takes images with lines of two directions at right angles."}{" "}
          Exports then ask for a focal length, or name a nominal one.
        </Note>
      )}
    </section>
  );
}
