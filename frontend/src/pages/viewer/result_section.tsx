import { Link } from "react-router";
import { formatCount } from "../../design/format";
import { Icon } from "../../design/icons";
import { Keys } from "../../design/kbd";
import { degrees, pixels, ratio } from "./match_text";
import type { MatchedImage } from "./matched_image";

interface ResultSectionProps {
  a: MatchedImage;
  /** The image as scored for the second submission. */
  b: MatchedImage | null;
  pathTo: (imageId: number) => string;
  /** Address of the picture with the lines drawn in. */
  overlay: string;
}

const METRICS: readonly {
  key: string;
  name: string;
  text: (value: number | null) => string;
  hint: string;
}[] = [
  { key: "f1", name: "F1", text: ratio, hint: "clearlines-v2, on this image alone" },
  { key: "precision", name: "Precision", text: ratio, hint: "True positives of all predictions" },
  { key: "recall", name: "Recall", text: ratio, hint: "True positives of all labels" },
  {
    key: "offset_mean",
    name: "Offset",
    text: pixels,
    hint: "Mean distance of true positives to their labels",
  },
  { key: "angle_error", name: "Angle", text: degrees, hint: "Mean angle of true positives to their labels" },
  { key: "mean_liou", name: "LIoU", text: ratio, hint: "Mean line IoU of true positives" },
];

/** The numbers of the image, and the way to its neighbours. */
export function ResultSection({ a, b, pathTo, overlay }: ResultSectionProps) {
  const rows = METRICS.filter(({ key }) => a.detail.metrics[key] !== undefined);
  return (
    <section className="panel-section" aria-label="Result on this image">
      <div className="panel-heading">
        <h2 className="numeric">
          Image {formatCount(a.detail.position)}{" "}
          <span className="muted">of {formatCount(a.detail.total)}</span>
        </h2>
        <nav className="panel-heading__end" aria-label="Images">
          <Neighbour id={a.detail.previous} label="Previous image" caps="P" pathTo={pathTo} />
          <Neighbour id={a.detail.next} label="Next image" caps="N" pathTo={pathTo} />
        </nav>
      </div>
      <table className="metric-table">
        <thead className={b === null ? "visually-hidden" : undefined}>
          <tr>
            <th scope="col">
              <span className="visually-hidden">Metric</span>
            </th>
            <th scope="col">A</th>
            {b === null ? null : <th scope="col">B</th>}
          </tr>
        </thead>
        <tbody>
          {rows.map(({ key, name, text, hint }) => (
            <tr key={key} title={hint}>
              <th scope="row">{name}</th>
              <td className="numeric">{text(a.detail.metrics[key] ?? null)}</td>
              {b === null ? null : <td className="numeric">{text(b.detail.metrics[key] ?? null)}</td>}
            </tr>
          ))}
          <tr title="Labels of this image that count, and predictions">
            <th scope="row">Labels, predictions</th>
            <td className="numeric">{sizes(a)}</td>
            {b === null ? null : <td className="numeric">{sizes(b)}</td>}
          </tr>
        </tbody>
      </table>
      <p className="panel-hint">
        <a href={overlay} download>
          <Icon name="download" size={14} /> Overlay picture
        </a>
      </p>
    </section>
  );
}

function sizes({ detail, counts }: MatchedImage): string {
  return `${formatCount(counts.found + counts.fn)}, ${formatCount(detail.predictions.length)}`;
}

interface NeighbourProps {
  id: number | null;
  label: string;
  caps: string;
  pathTo: (imageId: number) => string;
}

function Neighbour({ id, label, caps, pathTo }: NeighbourProps) {
  const icon = caps === "N" ? "right" : "left";
  if (id === null) {
    return (
      <span className="button button--quiet button--small" aria-disabled="true">
        <Icon name={icon} size={14} />
        <span className="visually-hidden">No {label.toLowerCase()}</span>
      </span>
    );
  }
  return (
    <Link className="button button--quiet button--small" to={pathTo(id)} aria-label={label} title={label}>
      <Icon name={icon} size={14} /> <Keys keys={[caps]} />
    </Link>
  );
}
