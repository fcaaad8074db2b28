import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { Link } from "react-router";
import { calibrationImagesQuery } from "../../../api/camera_endpoints";
import { Button } from "../../../design/button";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { Ellipsis } from "../../../design/ellipsis";
import { formatCount, formatQuantity } from "../../../design/format";
import { TableScroll } from "../../../design/table_scroll";
import { digits } from "../length_text";
import type { PartProps } from "../part_props";
import { useCameraAddress } from "../use_camera_address";

/** Rows that are shown before more are asked for. */
const STEP = 25;

/** What each image gave, those without which the lens would be most another first. */
export function ImagesTable({ calibration }: PartProps) {
  const { linkTo } = useCameraAddress();
  const [most, setMost] = useState(STEP);
  const { data } = useQuery(calibrationImagesQuery(calibration.id));
  if (!data) return <div className="skeleton maps__loading" role="status" aria-label="Loading the images" />;
  const sorted = [...data].sort((a, b) => (b.left_out_shift ?? -1) - (a.left_out_shift ?? -1));
  return (
    <section className="section card parameters__wide" aria-labelledby="images-title">
      <div className="section__header">
        <h2 id="images-title">What each image gave</h2>
        <p className="muted">
          The shift is how far the lens moves, RMS over the frame, if the image is left out
        </p>
      </div>
      <TableScroll label="Images">
        <table className="table">
          <ColumnHeads
            columns={[
              "Image",
              numbers("Lines"),
              numbers("Fit"),
              numbers("Residual, px"),
              numbers("Shift without it, px"),
            ]}
          />
          <tbody>
            {sorted.slice(0, most).map((image) => (
              <tr key={image.image_id}>
                <th scope="row" className="parameters__image">
                  {image.is_there ? (
                    <Link to={linkTo({ part: "image", image: image.image_id })}>
                      <Ellipsis text={image.name} end={14} />
                    </Link>
                  ) : (
                    <span className="muted">
                      <Ellipsis text={image.name} end={14} /> (deleted)
                    </span>
                  )}
                </th>
                <td className="table__number">{formatCount(image.segments)}</td>
                <td className="table__number">{formatCount(image.inliers)}</td>
                <td className="table__number">{image.rms === null ? "–" : digits(image.rms)}</td>
                <td className="table__number">
                  {image.left_out_shift === null ? "–" : digits(image.left_out_shift)}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
      {sorted.length > most ? (
        <div>
          <Button small icon="down" onClick={() => setMost(most + 4 * STEP)}>
            Show more of {formatQuantity(sorted.length, "image")}
          </Button>
        </div>
      ) : null}
    </section>
  );
}
