import { Link } from "react-router";
import type { Advice, AdviceCell } from "../../../api/camera_types";
import { thumbnailUrl } from "../../../api/endpoints";
import { Ellipsis } from "../../../design/ellipsis";
import { px } from "../length_text";
import { adviceText } from "./advice_text";

interface AdviceSectionProps {
  slug: string;
  advice: Advice | undefined;
  /** Why there is none. */
  failure: string | null;
}

/** What would make the lens better known: where lines are worth most, and in which images there are some. */
export function AdviceSection({ slug, advice, failure }: AdviceSectionProps) {
  if (advice === undefined) {
    return failure === null ? (
      <div className="skeleton maps__loading" role="status" aria-label="Loading the advice" />
    ) : (
      <p className="muted">{failure}</p>
    );
  }
  const { cells, images } = advice;
  return (
    <section className="section card maps__wide" aria-labelledby="advice-title">
      <div className="section__header">
        <h2 id="advice-title">Where more lines help most</h2>
        <p className="muted">Outlined on the maps</p>
      </div>
      <div className="advice">
        <div>
          {cells.length === 0 ? (
            <p className="muted">More lines would hardly change anything.</p>
          ) : (
            <ol className="advice__cells numeric">
              {cells.map((cell: AdviceCell) => (
                <li key={`${cell.column} ${cell.row}`}>{adviceText(cell)}</li>
              ))}
            </ol>
          )}
        </div>
        <div>
          <h3>Images to label next</h3>
          {images.length === 0 ? (
            <p className="muted">
              No image with candidates waits: pre-label more images of this camera, or draw lines by hand.
            </p>
          ) : (
            <ul className="advice__images">
              {images.map(({ image_id, name, gain }) => (
                <li key={image_id}>
                  <Link to={`/datasets/${slug}/images/${image_id}`} className="advice__image">
                    <img src={thumbnailUrl(image_id, 160)} alt="" loading="lazy" decoding="async" />
                    <span>
                      <Ellipsis text={name} end={12} />
                      <span className="muted numeric">{px(gain)} less error expected</span>
                    </span>
                  </Link>
                </li>
              ))}
            </ul>
          )}
        </div>
      </div>
    </section>
  );
}
