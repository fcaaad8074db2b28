import { useEffect, useRef } from "react";
import type { CalibrationImage } from "../../../api/camera_types";
import { thumbnailUrl } from "../../../api/endpoints";
import { IconButton } from "../../../design/button";
import { Ellipsis } from "../../../design/ellipsis";
import { formatCount, formatQuantity } from "../../../design/format";
import { px } from "../length_text";
import { around } from "./around";

interface ImageChooserProps {
  images: readonly CalibrationImage[];
  /** Place of the one that is shown. */
  current: number;
  onChoose: (place: number) => void;
}

/** So many pictures are in the strip at once, whatever the number of images. */
const SHOWN = 15;

/** The images of a camera as a strip of pictures around the one that is shown. */
export function ImageChooser({ images, current, onChoose }: ImageChooserProps) {
  const strip = useRef<HTMLUListElement>(null);
  const [first, end] = around(current, SHOWN, images.length);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another image is brought into view
  useEffect(() => {
    const shown = strip.current?.querySelector('[aria-current="true"]');
    const list = strip.current;
    if (!(shown instanceof HTMLElement) || !list) return;
    list.scrollTo({ left: shown.offsetLeft - (list.clientWidth - shown.clientWidth) / 2 });
  }, [current, images]);
  return (
    <nav className="image-chooser" aria-label="Images">
      <IconButton
        icon="left"
        label="Previous image"
        keys={["P"]}
        side="after"
        disabled={current <= 0}
        onClick={() => onChoose(current - 1)}
      />
      <ul ref={strip} className="image-chooser__strip">
        {images.slice(first, end).map((image, offset) => (
          <li key={image.image_id}>
            <button
              type="button"
              className="image-chooser__image"
              aria-current={first + offset === current}
              aria-label={imageText(image)}
              title={imageText(image)}
              onClick={() => onChoose(first + offset)}
            >
              <img src={thumbnailUrl(image.image_id, 160)} alt="" loading="lazy" decoding="async" />
              <span className="image-chooser__name">
                <Ellipsis text={image.name} end={8} />
              </span>
            </button>
          </li>
        ))}
      </ul>
      <label className="image-chooser__place numeric">
        <input
          className="input"
          type="number"
          min={1}
          max={images.length}
          aria-label="Number of the image"
          value={current + 1}
          onChange={(event) => {
            const place = Math.round(event.target.valueAsNumber) - 1;
            if (place >= 0 && place < images.length) onChoose(place);
          }}
        />
        <span className="muted">of {formatCount(images.length)}</span>
      </label>
      <IconButton
        icon="right"
        label="Next image"
        keys={["N"]}
        side="end"
        disabled={current >= images.length - 1}
        onClick={() => onChoose(current + 1)}
      />
    </nav>
  );
}

function imageText({ name, inliers, rms }: CalibrationImage): string {
  return inliers === 0
    ? `${name}: no line used`
    : `${name}: ${formatQuantity(inliers, "line")} fit, residual ${px(rms)}`;
}
