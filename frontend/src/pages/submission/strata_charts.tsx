import { IntervalBar } from "../../charts/interval_bar";
import { formatCount } from "../../design/format";
import { intervalText, metricText } from "../metrics";
import type { StrataOfKind, Stratum } from "./strata";

/** F1 of lines of one length, orientation, place or source. */
export function StrataCharts({ kinds }: { kinds: readonly StrataOfKind[] }) {
  return (
    <section className="section card" aria-labelledby="strata-title">
      <header className="section__header">
        <h2 id="strata-title">Where it is good</h2>
        <span className="muted">F1 with its interval</span>
      </header>
      <div className="strata">
        {kinds.map(({ kind, title, strata }) => (
          <table key={kind} className="strata__kind">
            <caption>{title}</caption>
            <thead className="visually-hidden">
              <tr>
                <th scope="col">Lines</th>
                <th scope="col">Picture</th>
                <th scope="col">F1</th>
                <th scope="col">Labels</th>
              </tr>
            </thead>
            <tbody>
              {strata.map((stratum) => (
                <Row key={stratum.name} stratum={stratum} />
              ))}
            </tbody>
          </table>
        ))}
      </div>
    </section>
  );
}

function Row({ stratum }: { stratum: Stratum }) {
  const { name, f1, precision, recall, tp, fp, fn } = stratum;
  const counts = `${formatCount(tp)} found, ${formatCount(fp)} wrong, ${formatCount(fn)} missed`;
  const rates = `P ${metricText("precision", precision.value)}, R ${metricText("recall", recall.value)}`;
  return (
    <tr title={`${rates}; ${counts}`}>
      <th scope="row">{name}</th>
      <td>
        {f1.value === null ? null : <IntervalBar {...f1} value={f1.value} domain={[0, 1]} width={150} />}
      </td>
      <td className="numeric">
        <strong>{metricText("f1", f1.value)}</strong>{" "}
        <span className="table__small strata__interval">{intervalText("f1", f1)}</span>
      </td>
      <td className="numeric muted strata__count">{formatCount(tp + fn)} labels</td>
    </tr>
  );
}
