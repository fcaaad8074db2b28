import type { Validation } from "../../api/board_types";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { Icon } from "../../design/icons";
import "./validation.css";

const NAMES_SHOWN = 200;

/** What the server understood of valid files. */
export function ValidationReport({ validation }: { validation: Validation }) {
  const { images, segments, points, has_scores, missing, left_out, warnings } = validation;
  return (
    <section className="validation" role="status" aria-label="Result of the check">
      <h2>
        <Icon name="check" /> Valid
      </h2>
      <p className="numeric">
        {formatQuantity(images, "image")}, {formatQuantity(segments, "segment")} of{" "}
        {formatQuantity(points, "point")};{" "}
        {has_scores ? "with scores, so AP is computed" : "without scores, so no AP"}.
      </p>
      <Names
        names={missing}
        text="without results: they are scored as if nothing was found there"
        one="image"
      />
      <Names names={left_out.map(({ file, reason }) => `${file}: ${reason}`)} text="left out" one="file" />
      {warnings.length > 0 ? (
        <ul className="validation__warnings">
          {warnings.map((warning) => (
            <li key={warning}>
              <Icon name="warning" /> {sentence(warning)}
            </li>
          ))}
        </ul>
      ) : null}
    </section>
  );
}

export function Names({ names, text, one }: { names: readonly string[]; text: string; one: string }) {
  if (names.length === 0) return null;
  return (
    <details className="validation__names">
      <summary className="numeric">
        {formatQuantity(names.length, one)} {text}
      </summary>
      <ul className="mono">
        {names.slice(0, NAMES_SHOWN).map((name) => (
          <li key={name}>{name}</li>
        ))}
        {names.length > NAMES_SHOWN ? <li>and {formatCount(names.length - NAMES_SHOWN)} more</li> : null}
      </ul>
    </details>
  );
}
