import { formatCount } from "../../design/format";
import type { ErrorsOfSide } from "./strata";

/** How many errors there are of each type: in what way it is wrong. */
export function ErrorTypes({ sides }: { sides: readonly ErrorsOfSide[] }) {
  return (
    <section className="section card" aria-labelledby="errors-title">
      <h2 id="errors-title">What goes wrong</h2>
      {sides.map(({ title, total, errors }) => (
        <table key={title} className="error-types">
          <caption>
            {title} <span className="tabs__count">{formatCount(total)}</span>
          </caption>
          <tbody>
            {errors.map(({ type, name, meaning, count }) => (
              <tr key={type}>
                <th scope="row">
                  {name}
                  <span className="table__small">{meaning}</span>
                </th>
                <td className="error-types__bar" aria-hidden="true">
                  {count > 0 ? <span style={{ width: `${(100 * count) / total}%` }} /> : null}
                </td>
                <td className="numeric error-types__count">
                  <strong>{formatCount(count)}</strong>{" "}
                  <span className="muted">{total > 0 ? `${Math.round((100 * count) / total)} %` : ""}</span>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      ))}
    </section>
  );
}
