import { Link } from "react-router";
import type { CalibrationLine, CameraDetail } from "../../../api/camera_types";
import { Ellipsis } from "../../../design/ellipsis";
import { formatCount } from "../../../design/format";
import { digits } from "../length_text";
import { segmentAddress } from "../segment_address";
import { LineCrop } from "./line_crop";

interface LineRowProps {
  camera: CameraDetail;
  line: CalibrationLine;
  /** Place in the list. */
  index: number;
  /** The one row that Tab leads to. */
  current: boolean;
  /** The residual at which the bar is full, px. */
  worst: number;
  onFocus: () => void;
}

/** Below it a line counts as bent in the world or mistaken, and hardly weighs. */
const FITS = 0.5;

const STATES: Record<CalibrationLine["state"], string> = {
  current: "",
  replaced: " · edited since",
  gone: " · gone since",
};

/** A line and what is left of its bend; it leads to the line in its image. */
export function LineRow({ camera, line, index, current, worst, onFocus }: LineRowProps) {
  const { image_id, segment_id, image, rms, maximum, length, probability, box, state } = line;
  return (
    <Link
      className="line-row"
      data-index={index}
      tabIndex={current ? 0 : -1}
      to={segmentAddress(camera.dataset.slug, image_id, segment_id)}
      aria-label={spoken(line)}
      aria-disabled={image === null}
      onFocus={onFocus}
      onClick={(event) => {
        if (image === null) event.preventDefault();
      }}
    >
      {box !== null && image !== null ? (
        <LineCrop imageId={image_id} box={box} frame={camera} />
      ) : (
        <span className="line-crop" />
      )}
      <span className="line-row__name">
        <Ellipsis text={image ?? "Image gone since"} end={14} />
        <span className="muted numeric">
          line {segment_id}
          {probability < FITS ? " · doesn't fit" : ""}
          {STATES[state]}
        </span>
      </span>
      <span className="line-row__residual numeric">
        <span className="line-row__bar" aria-hidden="true">
          <span style={{ width: `${Math.min(100, (100 * (rms ?? 0)) / worst)}%` }} />
        </span>
        {known(rms)}
      </span>
      <span className="line-row__number numeric">{known(maximum)}</span>
      <span className="line-row__number line-row__optional numeric">{formatCount(length)}</span>
      <span className="line-row__number line-row__optional numeric">{Math.round(100 * probability)} %</span>
    </Link>
  );
}

/** Beyond a fold of the lens a line has no residual. */
function known(length: number | null): string {
  return length === null ? "–" : digits(length);
}

function spoken({ image, segment_id, rms, maximum, length }: CalibrationLine): string {
  const where = image === null ? "an image that is gone" : image;
  return `Line ${segment_id} in ${where}: residual ${known(rms)} px, most ${known(maximum)} px, ${formatCount(length)} px long`;
}
