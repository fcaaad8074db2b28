import { sentence } from "../../../design/format";
import { Note } from "../../note";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { enoughText } from "./enough_text";
import { FieldMap } from "./field_map";

/** What a displacement field without a formula finds beyond the lens model. */
export function FreeModelMap({ camera, calibration }: PartProps) {
  const { free } = calibration.result;
  if (free === null) return null;
  return (
    <section className="section card" aria-labelledby="free-title">
      <div className="section__header">
        <h2 id="free-title">What the model misses</h2>
        <p className="muted">A smooth field fitted to what the lens model leaves over</p>
      </div>
      {free.used ? (
        <>
          <FieldMap
            label="What the lens model misses"
            frame={camera}
            field={free}
            text={(length) => `corrected points belong ${px(length)} further along the arrow`}
          />
          <p className="muted numeric">
            {px(free.rms)} RMS over the frame, known to {px(free.sigma)}. {enoughText(free)}{" "}
            {(free.rms ?? 0) < 2 * (free.sigma ?? 0)
              ? "That is no more than its own uncertainty: the model is good enough for these lines."
              : "That is more than its uncertainty: the lens does something that the model has no term for."}
          </p>
        </>
      ) : (
        <Note>
          {free.reason ? sentence(free.reason) : "Not fitted."}{" "}
          <span className="numeric">{enoughText(free)}</span>
        </Note>
      )}
    </section>
  );
}
