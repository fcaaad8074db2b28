import type { Totals } from "../../api/board_types";
import { IntervalBar } from "../../charts/interval_bar";
import { TableScroll } from "../../design/table_scroll";
import type { MetricGroup } from "../metric";
import { METRIC_GROUPS } from "../metric_groups";
import { intervalText, metricText } from "../metrics";

/** Every metric with its interval and what it means. */
export function TotalsTable({ totals }: { totals: Totals }) {
  const groups = METRIC_GROUPS.map((group) => ({
    ...group,
    metrics: group.metrics.filter(({ key }) => (totals[key]?.value ?? null) !== null),
  })).filter(({ metrics }) => metrics.length > 0);
  return (
    <section className="section card" aria-labelledby="totals-title">
      <header className="section__header">
        <h2 id="totals-title">All metrics</h2>
        <span className="muted">95 % intervals, bootstrap over images</span>
      </header>
      <TableScroll label="All metrics">
        <table className="table totals">
          <thead>
            <tr>
              <th scope="col">Metric</th>
              <th scope="col" className="table__number">
                Value
              </th>
              <th scope="col">Interval</th>
              <th scope="col">
                <span className="visually-hidden">Picture</span>
              </th>
              <th scope="col">What it says</th>
            </tr>
          </thead>
          {groups.map((group) => (
            <Group key={group.title} group={group} totals={totals} />
          ))}
        </table>
      </TableScroll>
    </section>
  );
}

function Group({ group, totals }: { group: MetricGroup; totals: Totals }) {
  return (
    <tbody>
      <tr className="totals__group">
        <th scope="rowgroup" colSpan={5}>
          {group.title} <span className="totals__protocol">{group.protocol}</span>
          <span className="table__small">{group.note}</span>
        </th>
      </tr>
      {group.metrics.map(({ key, name, unit, meaning }) => {
        const measured = totals[key];
        const value = measured?.value ?? null;
        return (
          <tr key={key}>
            <th scope="row">{name}</th>
            <td className="table__number">
              <strong>{metricText(key, value)}</strong>
            </td>
            <td className="table__small totals__interval">{intervalText(key, measured) || "–"}</td>
            <td>
              {unit === "share" && measured && value !== null ? (
                <IntervalBar {...measured} value={value} domain={[0, 1]} width={110} />
              ) : null}
            </td>
            <td className="muted">{meaning}</td>
          </tr>
        );
      })}
    </tbody>
  );
}
