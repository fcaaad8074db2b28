import { thumbnailUrl } from "../../../api/endpoints";
import type { FrameSize } from "../../../charts/frame_cells";
import { type CornerBox, cropAround } from "./crop";

interface LineCropProps {
  imageId: number;
  /** Around the line, image px. */
  box: CornerBox;
  frame: FrameSize;
}

/** The part of the picture in which a line lies. */
export function LineCrop({ imageId, box, frame }: LineCropProps) {
  const { x, y, width, height } = cropAround(box, frame);
  const [left, top, right, bottom] = box;
  return (
    <svg className="line-crop" viewBox={`${x} ${y} ${width} ${height}`} aria-hidden="true" focusable="false">
      <image
        href={thumbnailUrl(imageId, 640)}
        width={frame.width}
        height={frame.height}
        preserveAspectRatio="none"
      />
      <rect
        className="line-crop__box"
        x={left - 1}
        y={top - 1}
        width={right - left + 2}
        height={bottom - top + 2}
        rx={2}
      />
    </svg>
  );
}
