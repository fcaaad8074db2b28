import type { Statistics } from "../../../api/team_endpoints";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { formatCount } from "../../../design/format";
import { TableScroll } from "../../../design/table_scroll";
import { timeText } from "./time_text";

/** What each person did; in the order of how much. */
export function PeopleTable({ statistics }: { statistics: Statistics }) {
  const people = [...statistics.people].sort((a, b) => b.decisions - a.decisions);
  return (
    <section className="section card" aria-labelledby="people-title">
      <h2 id="people-title">People</h2>
      <TableScroll label="Work by person">
        <table className="table">
          <ColumnHeads
            columns={[
              "Person",
              numbers("Decisions"),
              numbers("Taken back"),
              numbers("Hours"),
              numbers("In an hour"),
              numbers("Median"),
              numbers("Half of them"),
            ]}
          />
          <tbody>
            {people.map(({ person, decisions, undone, hours, per_hour, times }) => (
              <tr key={person}>
                <th scope="row" className="statistics__name" title={person ?? undefined}>
                  {person ?? "Nobody's name"}
                </th>
                <td className="table__number">{formatCount(decisions)}</td>
                <td className="table__number">{formatCount(undone)}</td>
                <td className="table__number">{hours.toFixed(1)}</td>
                <td className="table__number">
                  {per_hour === null ? "–" : formatCount(Math.round(per_hour))}
                </td>
                <td className="table__number">{timeText(times.median)}</td>
                <td className="table__number">
                  {timeText(times.lower_quartile)} – {timeText(times.upper_quartile)}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
    </section>
  );
}
