import { useState } from "react";
import { Link } from "react-router";
import { thumbnailUrl } from "../../../api/endpoints";
import type { ImageDetail } from "../../../api/types";
import { useRights } from "../../../api/use_rights";
import { ReviewBadge } from "../../../design/badge";
import { Button } from "../../../design/button";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import type { PageActions } from "../actions/page_actions";
import { DiscardForm } from "./discard_form";

interface ImageSectionProps {
  slug: string;
  image: ImageDetail;
  actions: PageActions;
  /** Whether the reason for discarding is being asked for. */
  discarding: boolean;
  /** The neighbours' pictures wait until the image itself is there. */
  ready: boolean;
}

/** Where one is in the dataset, how far the image is, and the two neighbours. */
export function ImageSection({ slug, image, actions, discarding, ready }: ImageSectionProps) {
  const { label: judges } = useRights();
  return (
    <section className="panel-section" aria-label="Image">
      <div className="panel-heading">
        <h2 className="numeric">
          Image {image.position} <span className="muted">of {image.total}</span>
        </h2>
        <span className="panel-heading__end">
          <ReviewBadge status={image.status} />
          {!judges ? null : image.status !== "open" ? (
            <Button small tone="quiet" onClick={() => actions.setReview("open")}>
              Reopen
            </Button>
          ) : discarding ? null : (
            <Button small tone="quiet" aria-keyshortcuts="D" onClick={actions.discard}>
              Discard <Keys keys={["D"]} />
            </Button>
          )}
        </span>
      </div>
      {discarding ? (
        <DiscardForm
          onDiscard={(reason) => actions.setReview("discarded", reason)}
          onClose={actions.leaveSelection}
        />
      ) : null}
      <div className="neighbours">
        <Neighbour slug={slug} id={image.previous_id} ready={ready} label="Previous" caps="P" />
        <Neighbour slug={slug} id={image.next_id} ready={ready} label="Next" caps="N" />
      </div>
    </section>
  );
}

interface NeighbourProps {
  slug: string;
  id: number | null;
  ready: boolean;
  label: "Previous" | "Next";
  caps: string;
}

function Neighbour({ slug, id, ready, label, caps }: NeighbourProps) {
  const content = (
    <>
      {id === null ? null : ready ? <Thumbnail key={id} id={id} /> : <span className="neighbour__empty" />}
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
