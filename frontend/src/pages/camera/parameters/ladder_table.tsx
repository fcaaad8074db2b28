import type { CalibrationResult } from "../../../api/camera_types";
import { Badge } from "../../../design/badge";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { TableScroll } from "../../../design/table_scroll";
import { FAMILIES, reasonText, releasedText } from "../calibration_text";
import { digits } from "../length_text";
import { isChosen } from "./chosen";

/** The models that were tried, from the smallest on, and why each was taken or not. */
export function LadderTable({ result }: { result: CalibrationResult }) {
  return (
    <section className="section card parameters__wide" aria-labelledby="ladder-title">
      <div className="section__header">
        <h2 id="ladder-title">How the model was chosen</h2>
        <p className="muted">
          A step is taken where the penalised likelihood and the held-out images both gain by it
        </p>
      </div>
      <TableScroll label="Models that were tried">
        <table className="table ladder">
          <ColumnHeads
            columns={[
              "Model",
              "Free",
              numbers("Penalised"),
              numbers("Held out"),
              numbers("Expected error, px"),
              "",
              "Why",
            ]}
          />
          <tbody>
            {result.ladder.map((step) => (
              <tr key={`${step.family} ${step.released.join()}`}>
                <th scope="row">{FAMILIES[step.family as keyof typeof FAMILIES]?.name ?? step.family}</th>
                <td>{releasedText(step.released)}</td>
                <td className="table__number">{step.penalised.toFixed(1).replace(/^-/, "−")}</td>
                <td className="table__number">
                  {step.held_out === null ? "–" : step.held_out.toFixed(1).replace(/^-/, "−")}
                </td>
                <td className="table__number">{step.pred === null ? "–" : digits(step.pred)}</td>
                <td>
                  {isChosen(step, result) ? (
                    <Badge tone="success" icon="check">
                      Chosen
                    </Badge>
                  ) : step.accepted ? (
                    <Badge tone="accent" icon="up">
                      Better
                    </Badge>
                  ) : (
                    <Badge icon="cross">No better</Badge>
                  )}
                </td>
                <td className="muted">{reasonText(step.reason)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
    </section>
  );
}
