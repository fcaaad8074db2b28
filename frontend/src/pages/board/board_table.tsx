import { useRef, useState } from "react";
import { Link } from "react-router";
import type { BoardRow } from "../../api/board_types";
import { IntervalBar } from "../../charts/interval_bar";
import { fittedDomain } from "../../charts/scale";
import { Button } from "../../design/button";
import { formatCount, formatDay, sentence } from "../../design/format";
import { Icon, type IconName } from "../../design/icons";
import { TableScroll } from "../../design/table_scroll";
import { intervalText, metricText } from "../metrics";
import { KindBadge } from "../split_badges";
import { useArrowKeys } from "../use_arrow_keys";
import { BoardHead } from "./board_head";
import {
  knownMetrics,
  METRIC_COLUMNS,
  OFFICIAL_COLUMNS,
  rankText,
  type Sort,
  tiedText,
  totalOf,
} from "./board_rows";

/** A board longer than this waits for being asked, so that what is below it stays within reach. */
const FIRST_ROWS = 50;
/** So few more aren't worth the asking. */
const SPARE_ROWS = 10;

interface BoardTableProps {
  rows: readonly BoardRow[];
  sort: Sort;
  onSort: (sort: Sort) => void;
  highlighted: string | null;
  onHighlight: (slug: string | null) => void;
}

export function BoardTable({ rows, sort, onSort, highlighted, onHighlight }: BoardTableProps) {
  const table = useRef<HTMLDivElement>(null);
  const [whole, setWhole] = useState(false);
  const shown = whole || rows.length < FIRST_ROWS + SPARE_ROWS ? rows : rows.slice(0, FIRST_ROWS);
  useArrowKeys(table, ".board-method__name a");
  const metrics = knownMetrics(rows, METRIC_COLUMNS).filter((key) => key !== "f1");
  const official = knownMetrics(rows, OFFICIAL_COLUMNS);
  const domain = fittedDomain(
    rows.flatMap(({ totals: { f1 } }) => [f1?.value, f1?.low, f1?.high].flatMap((value) => value ?? [])),
    { step: 0.05, width: 0.1, limits: [0, 1] },
  );
  const warned = rows.some(({ warning }) => warning !== null);
  return (
    <div ref={table} className="card board-table">
      <TableScroll label="Leaderboard">
        <table className="table">
          <caption className="visually-hidden">Leaderboard</caption>
          <BoardHead metrics={metrics} official={official} sort={sort} onSort={onSort} />
          <tbody>
            {shown.map((row) => (
              <tr
                key={row.method.slug}
                className={`board-row board-row--${row.method.kind}`}
                data-current={row.method.slug === highlighted || undefined}
                data-tied={(highlighted !== null && row.tied_with.includes(highlighted)) || undefined}
                onPointerEnter={() => onHighlight(row.method.slug)}
                onPointerLeave={() => onHighlight(null)}
              >
                <Rank row={row} rows={rows} />
                <MethodCell row={row} />
                <F1Cell row={row} domain={domain} />
                {metrics.map((key) => (
                  <td
                    key={key}
                    className="table__number"
                    title={intervalText(key, row.totals[key]) || undefined}
                  >
                    {metricText(key, totalOf(row, key))}
                  </td>
                ))}
                {official.map((key) => (
                  <OfficialCell key={key} row={row} metric={key} first={key === official[0]} />
                ))}
                <td className="table__number table__small board-scored">
                  {row.scored_at ? <time dateTime={row.scored_at}>{formatDay(row.scored_at)}</time> : "–"}
                </td>
                <td>
                  <span className="board-links">
                    <OutLink href={row.method.code_url} icon="code" label={`Code of ${row.method.name}`} />
                    <OutLink href={row.method.paper_url} icon="paper" label={`Paper on ${row.method.name}`} />
                  </span>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
      {shown.length < rows.length ? (
        <p className="board-table__more">
          <Button small icon="down" onClick={() => setWhole(true)}>
            Show all {formatCount(rows.length)} methods
          </Button>
        </p>
      ) : null}
      {warned && official.length > 0 ? (
        <p className="board-footnote muted">
          <Icon name="warning" size={14} /> official-v1 counts every prediction that lies on a label: where R
          is above 1, several predictions stand on the same label, and the F1 beside it means nothing.
        </p>
      ) : null}
    </div>
  );
}

function Rank({ row, rows }: { row: BoardRow; rows: readonly BoardRow[] }) {
  const text = tiedText(row, rows) ?? undefined;
  return (
    <td className="board-rank numeric" title={text}>
      {rankText(row)}
      {text ? (
        <span className="board-tied">
          <span aria-hidden="true">tied</span>
          <span className="visually-hidden">{text}</span>
        </span>
      ) : null}
    </td>
  );
}

function MethodCell({ row }: { row: BoardRow }) {
  const { method, label, person, submission_id } = row;
  return (
    <th scope="row" className="board-method">
      <span className="board-method__name">
        <Link to={`/methods/${method.slug}`} title={method.name}>
          {method.name}
        </Link>
        <KindBadge kind={method.kind} />
      </span>
      <span className="table__small board-method__by">
        {label && submission_id !== null ? <Link to={`/submissions/${submission_id}`}>{label}</Link> : label}
        {label && (person || method.kind === "method") ? " · " : null}
        {person ?? (method.kind === "method" ? "anonymous" : null)}
      </span>
    </th>
  );
}

function F1Cell({ row, domain }: { row: BoardRow; domain: readonly [number, number] }) {
  const { f1 } = row.totals;
  if (!f1 || f1.value === null) return <td className="table__number">–</td>;
  const text = metricText("f1", f1.value);
  return (
    <td className="board-f1">
      <span className="board-f1__value">
        {row.submission_id === null ? (
          <strong>{text}</strong>
        ) : (
          <Link to={`/submissions/${row.submission_id}`} title="Open this submission">
            <strong>{text}</strong>
          </Link>
        )}
        <IntervalBar
          value={f1.value}
          low={f1.low}
          high={f1.high}
          domain={domain}
          aside={row.method.kind !== "method"}
        />
      </span>
      <span className="table__small">{intervalText("f1", f1)}</span>
    </td>
  );
}

function OfficialCell({ row, metric, first }: { row: BoardRow; metric: string; first: boolean }) {
  const warned = metric === "official_recall" && row.warning !== null;
  return (
    <td className={`table__number board-official${first ? " board-official--first" : ""}`}>
      {metricText(metric, totalOf(row, metric))}
      {warned ? (
        <span className="board-warning" title={sentence(row.warning ?? "")}>
          <Icon name="warning" size={14} />
          <span className="visually-hidden">{sentence(row.warning ?? "")}</span>
        </span>
      ) : null}
    </td>
  );
}

function OutLink({ href, icon, label }: { href: string | null; icon: IconName; label: string }) {
  // The server takes http and https alone; anything else isn't made a link here either.
  if (href === null || !/^https?:\/\//i.test(href)) return null;
  return (
    <a href={href} target="_blank" rel="noopener noreferrer" aria-label={label} title={label}>
      <Icon name={icon} />
    </a>
  );
}
