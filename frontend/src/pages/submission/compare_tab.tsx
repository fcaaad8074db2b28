import { useQuery } from "@tanstack/react-query";
import { Link, useSearchParams } from "react-router";
import { comparisonQuery } from "../../api/board_queries";
import type { Comparison, Difference, Submission } from "../../api/board_types";
import { buttonClass } from "../../design/button";
import { ColumnHeads, numbers } from "../../design/column_heads";
import { formatCount } from "../../design/format";
import { Icon } from "../../design/icons";
import { EmptyState, ErrorState } from "../../design/states";
import { TableScroll } from "../../design/table_scroll";
import type { MetricGroup } from "../metric";
import { METRIC_GROUPS } from "../metric_groups";
import { differenceText, intervalText, isBetter, metricText } from "../metrics";
import { useComparableSubmissions } from "../use_comparable_submissions";
import { turned } from "./difference";

/** Paired differences to another submission on the same images. */
export function CompareTab({ submission }: { submission: Submission }) {
  const [parameters, setParameters] = useSearchParams();
  const wanted = Number(parameters.get("with"));
  const other = Number.isInteger(wanted) && wanted > 0 && wanted !== submission.id ? wanted : null;
  const { pending, submissions: choices } = useComparableSubmissions(submission);
  const choose = (id: string) => {
    const next = new URLSearchParams(parameters);
    if (id === "") next.delete("with");
    else next.set("with", id);
    setParameters(next, { preventScrollReset: true });
  };
  const known = choices.some(({ id }) => id === other);
  return (
    <section className="section card" aria-labelledby="compare-title">
      <header className="section__header">
        <h2 id="compare-title">Compared on the same images</h2>
        <label className="compare-choice">
          <span className="muted">With</span>
          <select className="input" value={other ?? ""} onChange={(event) => choose(event.target.value)}>
            <option value="">Choose a submission</option>
            {other !== null && !known ? <option value={other}>Submission {other}</option> : null}
            {choices.map(({ id, method, label }) => (
              <option key={id} value={id}>
                {method}, {label ?? `submission ${id}`}
              </option>
            ))}
          </select>
        </label>
      </header>
      {other === null ? (
        <EmptyState
          icon="compare"
          title={choices.length === 0 && !pending ? "Nothing to compare with yet" : "Compare with another"}
        >
          Both are scored on the same images, so the interval of their difference is far narrower than the
          intervals of the two.
        </EmptyState>
      ) : (
        <ComparisonView submission={submission} other={other} />
      )}
    </section>
  );
}

function ComparisonView({ submission, other }: { submission: Submission; other: number }) {
  const comparison = useQuery(comparisonQuery(submission.id, other));
  if (comparison.isError) return <ErrorState error={comparison.error} onRetry={() => comparison.refetch()} />;
  if (!comparison.data) {
    return <div className="skeleton board-page__loading" role="status" aria-label="Comparing" />;
  }
  return (
    <>
      <ImagesShare comparison={comparison.data} />
      <TableScroll label="Differences">
        <table className="table compare">
          <ColumnHeads
            columns={[
              "Metric",
              numbers("This"),
              numbers("Other"),
              numbers("Difference"),
              "95 % interval",
              "Says",
            ]}
          />
          {METRIC_GROUPS.map((group) => (
            <Group key={group.title} group={group} differences={comparison.data.metrics} />
          ))}
        </table>
      </TableScroll>
      <p>
        <Link className={buttonClass()} to={`/submissions/${submission.id}?tab=images&with=${other}`}>
          <Icon name="images" /> Images, with both in the viewer
        </Link>
      </p>
    </>
  );
}

function Group({ group, differences }: { group: MetricGroup; differences: Comparison["metrics"] }) {
  const rows = group.metrics.flatMap(({ key, name }) => {
    const difference = differences[key];
    return difference && difference.difference !== null
      ? [{ key, name, difference: turned(difference) }]
      : [];
  });
  if (rows.length === 0) return null;
  return (
    <tbody>
      <tr className="totals__group">
        <th scope="rowgroup" colSpan={6}>
          {group.title} <span className="totals__protocol">{group.protocol}</span>
        </th>
      </tr>
      {rows.map(({ key, name, difference }) => (
        <Row key={key} metric={key} name={name} difference={difference} />
      ))}
    </tbody>
  );
}

function Row({ metric, name, difference }: { metric: string; name: string; difference: Difference }) {
  return (
    <tr>
      <th scope="row">{name}</th>
      <td className="table__number">{metricText(metric, difference.a)}</td>
      <td className="table__number">{metricText(metric, difference.b)}</td>
      <td className="table__number">
        <strong>{differenceText(metric, difference.difference)}</strong>
      </td>
      <td className="table__small">{intervalText(metric, difference)}</td>
      <td>
        <Conclusion metric={metric} difference={difference} />
      </td>
    </tr>
  );
}

function Conclusion({ metric, difference }: { metric: string; difference: Difference }) {
  if (difference.tied || difference.difference === null)
    return <span className="muted">can't be told apart</span>;
  const better = isBetter(metric, difference.difference);
  if (better === null) return <span className="muted">different</span>;
  return (
    <span className={better ? "compare--better" : "compare--worse"}>
      <Icon name={better ? "up" : "down"} size={12} /> {better ? "this is better" : "this is worse"}
    </span>
  );
}

function ImagesShare({ comparison }: { comparison: Comparison }) {
  // The server counts for the second one.
  const { better: worse, worse: better, equal } = comparison.images;
  const text = `This one has the higher F1 on ${formatCount(better)} images, the other on ${formatCount(worse)}; equal on ${formatCount(equal)}.`;
  return (
    <div className="compare-images">
      <span className="stacked-bar" role="img" aria-label={text}>
        {better > 0 ? <span style={{ flexGrow: better, background: "var(--accent)" }} /> : null}
        {equal > 0 ? <span style={{ flexGrow: equal }} /> : null}
        {worse > 0 ? <span style={{ flexGrow: worse, background: "var(--reject)" }} /> : null}
      </span>
      <p className="muted numeric">{text}</p>
    </div>
  );
}
