import { useRef } from "react";
import type { Measured, Submission } from "../../api/board_types";
import { IntervalBar } from "../../charts/interval_bar";
import { useWidth } from "../../charts/use_width";
import { ColumnHeads, numbers } from "../../design/column_heads";
import { formatDate } from "../../design/format";
import { EmptyState } from "../../design/states";
import { TableScroll } from "../../design/table_scroll";
import { intervalText, metricOf, metricText } from "../metrics";
import { ErrorTypes } from "./error_types_chart";
import { F1GridTable } from "./f1_grid_table";
import { currentScores, currentTotals, headline } from "./scores";
import { readErrorTypes, readReasons, readStrata } from "./strata";
import { StrataCharts } from "./strata_charts";
import { TotalsTable } from "./totals_table";

const HEADLINE = ["f1", "precision", "recall"] as const;

export function Overview({ submission }: { submission: Submission }) {
  const totals = currentTotals(submission.scores);
  if (submission.scores.length === 0) {
    return <EmptyState icon="clock" title="No numbers yet" />;
  }
  const strata = readStrata(submission.strata);
  const reasons = readReasons(submission.strata);
  const types = readErrorTypes(submission.error_types);
  const errors = reasons === null ? types : [...types, reasons];
  return (
    <>
      <ul className="headline">
        {HEADLINE.map((key) => {
          const measured = totals[key];
          if (!measured || measured.value === null) return null;
          return <HeadlineItem key={key} metric={key} measured={measured} value={measured.value} />;
        })}
      </ul>
      {strata.length > 0 || errors.length > 0 ? (
        <div className="overview-charts">
          {errors.length > 0 ? <ErrorTypes sides={errors} /> : null}
          {strata.length > 0 ? <StrataCharts kinds={strata} /> : null}
        </div>
      ) : null}
      <TotalsTable totals={totals} />
      {submission.f1_grid ? <F1GridTable grid={submission.f1_grid} /> : null}
      <Provenance submission={submission} />
    </>
  );
}

function HeadlineItem({ metric, measured, value }: { metric: string; measured: Measured; value: number }) {
  const bar = useRef<HTMLDivElement>(null);
  const width = useWidth(bar, 200);
  return (
    <li className="headline__item card">
      <span className="muted">{metricOf(metric).name}</span>
      <strong className="headline__value numeric">{metricText(metric, value)}</strong>
      <div ref={bar} className="headline__bar">
        <IntervalBar {...measured} value={value} domain={[0, 1]} width={width} />
      </div>
      <span className="muted numeric">{intervalText(metric, measured)}</span>
    </li>
  );
}

/** Under what the numbers stand. */
function Provenance({ submission }: { submission: Submission }) {
  const { current, older } = currentScores(submission.scores);
  return (
    <section className="section card" aria-labelledby="provenance-title">
      <h2 id="provenance-title">Under what these numbers stand</h2>
      <TableScroll label="Under what these numbers stand">
        <table className="table">
          <ColumnHeads
            columns={["Protocol", "Version", "Scorer", "Ground truth", numbers("F1"), numbers("Scored")]}
          />
          <tbody>
            {[...current, ...older].map((score, index) => (
              <tr
                key={`${score.protocol} ${score.protocol_version} ${score.split_version}`}
                className={index >= current.length ? "muted" : undefined}
              >
                <th scope="row">
                  {score.protocol}
                  {index >= current.length ? " (earlier)" : ""}
                </th>
                <td>{score.protocol_version}</td>
                <td>{score.scorer_version}</td>
                <td>version {score.split_version}</td>
                <td className="table__number">{metricText("f1", headline(score)?.value)}</td>
                <td className="table__number">{score.done_at ? formatDate(score.done_at) : "–"}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
      <dl className="provenance">
        {submission.truth_hash ? (
          <div>
            <dt>Ground truth</dt>
            <dd className="mono">{submission.truth_hash}</dd>
          </div>
        ) : null}
        {submission.submission_hash ? (
          <div>
            <dt>Submission</dt>
            <dd className="mono">{submission.submission_hash}</dd>
          </div>
        ) : null}
      </dl>
    </section>
  );
}
