import { type MouseEvent, memo, useEffect, useState } from "react";
import { Link } from "react-router";
import { thumbnailUrl } from "../../api/endpoints";
import type { ImageSummary } from "../../api/types";
import { PrelabelBadge, ReviewBadge } from "../../design/badge";
import { Ellipsis } from "../../design/ellipsis";
import { formatCount, sentence } from "../../design/format";
import { Icon } from "../../design/icons";
import { VerdictBar } from "../../design/progress";
import { imageCameLabelled, imageSegmentsText } from "../labelled";
import { verdictText } from "../verdict_text";

/** A picture is asked for once its tile has stayed in view this long, so that scrolling past asks for nothing. */
const SETTLED_MS = 70;

interface ImageTileProps {
  image: ImageSummary;
  slug: string;
  index: number;
  size: 160 | 320 | 640;
  selected: boolean;
  /** The one tile that Tab leads to. */
  current: boolean;
  onPress: (event: MouseEvent, image: ImageSummary, index: number) => void;
  /** Null where nothing can be selected. */
  onCheck: ((event: MouseEvent, image: ImageSummary, index: number) => void) | null;
}

export const ImageTile = memo(function ImageTile(props: ImageTileProps) {
  const { image, slug, index, size, selected, current, onPress, onCheck } = props;
  const deleted = image.deleted_at !== null;
  return (
    <div className={`image-tile${selected ? " image-tile--selected" : ""}`}>
      <Link
        className="image-tile__link"
        to={`/datasets/${slug}/images/${image.id}`}
        data-index={index}
        tabIndex={current ? 0 : -1}
        draggable={false}
        aria-disabled={deleted}
        aria-label={spoken(image)}
        onClick={(event) => onPress(event, image, index)}
      >
        <Thumbnail id={image.id} size={size} />
        <span className="image-tile__caption">
          <Ellipsis text={image.name} end={12} />
          <span className="image-tile__state numeric">
            <State image={image} />
          </span>
          <VerdictBar counts={image.verdicts} />
        </span>
      </Link>
      {onCheck ? (
        <label className="image-tile__check">
          <input
            type="checkbox"
            tabIndex={-1}
            checked={selected}
            aria-label={`Select ${image.name}`}
            readOnly
            onClick={(event) => onCheck(event, image, index)}
          />
        </label>
      ) : null}
    </div>
  );
});

function Thumbnail({ id, size }: { id: number; size: 160 | 320 | 640 }) {
  const [settled, setSettled] = useState(false);
  const [broken, setBroken] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setSettled(true), SETTLED_MS);
    return () => clearTimeout(timer);
  }, []);
  return (
    <span className="image-tile__media">
      {broken ? (
        <Icon name="image" size={24} />
      ) : settled ? (
        <img
          src={thumbnailUrl(id, size)}
          alt=""
          decoding="async"
          draggable={false}
          onError={() => setBroken(true)}
        />
      ) : null}
    </span>
  );
}

function State({ image }: { image: ImageSummary }) {
  if (image.prelabel === "failed") {
    const reason = sentence(image.error?.message ?? "Pre-labelling failed");
    return (
      <span className="image-tile__failure" title={reason}>
        <Icon name="warning" size={12} /> <span>{reason}</span>
      </span>
    );
  }
  const working = image.prelabel === "queued" || image.prelabel === "running";
  return (
    <>
      <ReviewBadge status={image.status} />
      {working ? (
        <PrelabelBadge status={image.prelabel} />
      ) : imageCameLabelled(image) ? (
        <span className="muted" title={verdictText(image.verdicts)}>
          {imageSegmentsText(image)}
        </span>
      ) : image.candidates > 0 ? (
        <span className="muted" title={verdictText(image.verdicts)}>
          {formatCount(image.candidates - image.verdicts.undecided)}/{formatCount(image.candidates)}
        </span>
      ) : (
        <span className="muted">{image.prelabel === "done" ? "No candidates" : "Not pre-labelled"}</span>
      )}
    </>
  );
}

function spoken(image: ImageSummary): string {
  const work = image.prelabel === "failed" ? `pre-labelling failed: ${image.error?.message ?? ""}` : "";
  return [image.name, image.status, work || imageSegmentsText(image)].join(", ");
}
