import { TableScroll } from "../../../design/table_scroll";
import { strongest } from "./strongest";

interface CorrelationMatrixProps {
  released: readonly string[];
  correlation: readonly (readonly number[])[];
}

/** Which parameters can't be told apart: the numbers in a table, on a ground that is the stronger the more they are. */
export function CorrelationMatrix({ released, correlation }: CorrelationMatrixProps) {
  const worst = strongest(released, correlation);
  return (
    <section className="section card" aria-labelledby="correlation-title">
      <div className="section__header">
        <h2 id="correlation-title">Correlation</h2>
        <p className="muted">Near ±1, one parameter can stand in for the other</p>
      </div>
      {released.length === 0 ? (
        <p className="muted">No parameter was free.</p>
      ) : (
        <TableScroll label="Correlation of the parameters">
          <table className="correlation numeric">
            <thead>
              <tr>
                <th />
                {released.map((name) => (
                  <th key={name} scope="col">
                    {name}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {released.map((name, row) => (
                <tr key={name}>
                  <th scope="row">{name}</th>
                  {released.map((other, column) => {
                    const value = correlation[row]?.[column] ?? 0;
                    return (
                      <td key={other} className={`correlation__cell ${tone(value, row === column)}`}>
                        {value.toFixed(2).replace(/^-/, "−")}
                      </td>
                    );
                  })}
                </tr>
              ))}
            </tbody>
          </table>
        </TableScroll>
      )}
      {worst ? (
        <p className="muted numeric">
          Strongest: {worst.first} and {worst.second}, {worst.value.toFixed(2).replace(/^-/, "−")}.
        </p>
      ) : null}
    </section>
  );
}

/** Four steps to either side of zero. */
function tone(value: number, diagonal: boolean): string {
  if (diagonal) return "correlation__cell--itself";
  const step = Math.min(4, Math.floor(Math.abs(value) * 5));
  return step === 0 ? "" : `correlation__cell--${value < 0 ? "less" : "more"}-${step}`;
}
