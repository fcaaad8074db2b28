import type { Statistics } from "../../../api/team_endpoints";
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
          <thead>
            <tr>
              <th scope="col">Person</th>
              <th scope="col" className="table__number">
                Decisions
              </th>
              <th scope="col" className="table__number">
                Taken back
              </th>
              <th scope="col" className="table__number">
                Hours
              </th>
              <th scope="col" className="table__number">
                In an hour
              </th>
              <th scope="col" className="table__number">
                Median
              </th>
              <th scope="col" className="table__number">
                Half of them
              </th>
            </tr>
          </thead>
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
