import { MATCH_STYLES, type Palette } from "../../canvas/match_style";
import { Button, IconButton } from "../../design/button";
import { capitalized } from "../../design/format";
import { Keys } from "../../design/kbd";
import { LineMark } from "../../image_view/line_mark";
import { Magnifier } from "../../image_view/magnifier";
import { errorTypeOf } from "../error_type_names";
import { LAYER_NAMES } from "./layers";
import { degrees, lineTitle, pixels, ratio, rejectionText } from "./match_text";
import type { MatchedImage, MatchedLine } from "./matched_image";

/** Whether the selected line can be sent to the review queue, and whether it has been. */
export type ReviewState = "impossible" | "possible" | "sending" | "sent";

interface LineSectionProps {
  image: MatchedImage;
  line: MatchedLine | null;
  bitmap: ImageBitmap | null;
  palette: Palette;
  review: ReviewState;
  onReview: () => void;
  onPartner: (line: MatchedLine) => void;
  onCopyLink: () => void;
}

/** The selected line: why it counts as what it counts as. */
export function LineSection(props: LineSectionProps) {
  const { image, line, bitmap, palette, review, onReview, onPartner, onCopyLink } = props;
  if (line === null) {
    return (
      <section className="panel-section" aria-label="Selected line">
        <h2>Line</h2>
        <p className="muted panel-hint">
          Click a line, or press <Keys keys={["J"]} /> for the first error.
        </p>
      </section>
    );
  }
  const style = MATCH_STYLES[palette].plain[line.layer];
  const error = errorTypeOf(line.errorType);
  const rejected = rejectionText(line);
  const partner = line.partner === null ? undefined : image.lines[line.partner];
  return (
    <section className="panel-section" aria-label="Selected line">
      <div className="panel-heading">
        <h2 className="line-title">
          <LineMark style={style} />
          {LAYER_NAMES[line.layer].one}
        </h2>
        <span className="panel-heading__end muted numeric">
          {lineTitle(line)}
          <IconButton small icon="copy" label="Copy link" keys={["L"]} side="end" onClick={onCopyLink} />
        </span>
      </div>
      {error === null ? null : (
        <p className="panel-note error-note">
          <strong>{error.name}.</strong> {error.why}
        </p>
      )}
      {rejected === null ? null : (
        <p className="panel-hint" title="When the labels were made">
          {capitalized(rejected)}
        </p>
      )}
      <Magnifier scene={image.scene} bitmap={bitmap} index={line.index} colour={style.colour} />
      <Facts line={line} />
      {partner === undefined ? null : (
        <p className="panel-hint">
          <span className="muted">{partner.kind === "label" ? "Closest label:" : "Closest prediction:"}</span>{" "}
          <button type="button" className="partner-link" onClick={() => onPartner(partner)}>
            {lineTitle(partner)}, {LAYER_NAMES[partner.layer].one.toLowerCase()}
          </button>
        </p>
      )}
      {review === "impossible" ? null : (
        <Button
          small
          busy={review === "sending"}
          disabled={review === "sent"}
          icon={review === "sent" ? "check" : "external"}
          onClick={onReview}
        >
          {review === "sent" ? "In the review queue" : "Send to review"}
          {review === "sent" ? null : <Keys keys={["R"]} />}
        </Button>
      )}
    </section>
  );
}

function Facts({ line }: { line: MatchedLine }) {
  const facts: [string, string, string?][] = [
    ["LIoU", ratio(line.liou), "Line IoU with the closest line of the other kind"],
    ["Length", pixels(line.length)],
    ["Offset", pixels(line.offset, 2), "Mean distance to the label"],
    ["Angle", degrees(line.angle), "Mean angle to the label"],
  ];
  if (line.kind === "prediction") facts.push(["Score", ratio(line.score), "As submitted"]);
  return (
    <dl className="facts">
      {facts.map(([name, value, hint]) => (
        <div key={name} title={hint}>
          <dt>{name}</dt>
          <dd className="numeric">{value}</dd>
        </div>
      ))}
    </dl>
  );
}
