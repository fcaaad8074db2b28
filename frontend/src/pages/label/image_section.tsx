import { useState } from "react";
import { Link } from "react-router";
import { thumbnailUrl } from "../../api/endpoints";
import type { ImageDetail } from "../../api/types";
import { ReviewBadge } from "../../design/badge";
import { Icon } from "../../design/icons";
import { Keys } from "../../design/kbd";

/** Where one is in the dataset, and the two neighbours. */
export function ImageSection({ slug, image }: { slug: string; image: ImageDetail }) {
  return (
    <section className="panel-section" aria-label="Image">
      <div className="panel-heading">
        <h2 className="numeric">
          Image {image.position} <span className="muted">of {image.total}</span>
        </h2>
        <ReviewBadge status={image.status} />
      </div>
      <div className="neighbours">
        <Neighbour slug={slug} id={image.previous_id} label="Previous" caps="P" />
        <Neighbour slug={slug} id={image.next_id} label="Next" caps="N" />
      </div>
    </section>
  );
}

interface NeighbourProps {
  slug: string;
  id: number | null;
  label: "Previous" | "Next";
  caps: string;
}

function Neighbour({ slug, id, label, caps }: NeighbourProps) {
  const content = (
    <>
      {id === null ? null : <Thumbnail key={id} id={id} />}
      <span className="neighbour__label">
        <Icon name={label === "Next" ? "right" : "left"} size={14} />
        {id === null ? `No ${label.toLowerCase()}` : label}
        {id === null ? null : <Keys keys={[caps]} />}
      </span>
    </>
  );
  if (id === null) return <span className="neighbour neighbour--none">{content}</span>;
  return (
    <Link className="neighbour" to={`/datasets/${slug}/images/${id}`} aria-label={`${label} image`}>
      {content}
    </Link>
  );
}

/** An image that can't be shown leaves its place empty rather than broken. */
function Thumbnail({ id }: { id: number }) {
  const [failed, setFailed] = useState(false);
  if (failed) return <span className="neighbour__empty" />;
  return <img src={thumbnailUrl(id, 160)} alt="" loading="lazy" onError={() => setFailed(true)} />;
}
