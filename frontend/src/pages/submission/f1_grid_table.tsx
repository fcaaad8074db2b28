import type { F1Grid } from "../../api/board_types";
import { TableScroll } from "../../design/table_scroll";
import { metricText } from "../metrics";

/** F1 over tolerances and overlaps: the numbers that mean F1 is the mean of. */
export function F1GridTable({ grid }: { grid: F1Grid }) {
  return (
    <section className="section card" aria-labelledby="grid-title">
      <header className="section__header">
        <h2 id="grid-title">What mean F1 is the mean of</h2>
        <span className="muted">F1 by tolerance (px) and by the line IoU that is asked for</span>
      </header>
      <TableScroll label="F1 over distances and overlaps">
        <table className="f1-grid">
          <thead>
            <tr>
              <th scope="col">Tolerance</th>
              {grid.thresholds.map((threshold) => (
                <th key={threshold} scope="col">
                  {threshold.toFixed(2)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {grid.taus.map((tau, row) => (
              <tr key={tau}>
                <th scope="row">{tau} px</th>
                {grid.thresholds.map((threshold, column) => {
                  const f1 = grid.f1[row]?.[column] ?? null;
                  const share = `${Math.round(70 * (f1 ?? 0))}%`;
                  return (
                    <td
                      key={threshold}
                      style={{ background: `color-mix(in srgb, var(--accent-soft) ${share}, transparent)` }}
                      data-rank={tau === 3 && threshold === 0.5 ? "" : undefined}
                    >
                      {metricText("f1", f1)}
                    </td>
                  );
                })}
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
      <p className="muted">The framed number is the one that the rank goes by.</p>
    </section>
  );
}
