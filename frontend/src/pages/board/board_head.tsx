import { Icon } from "../../design/icons";
import { metricOf } from "../metrics";
import { nextSort, type Sort } from "./board_rows";

interface BoardHeadProps {
  metrics: readonly string[];
  official: readonly string[];
  sort: Sort;
  onSort: (sort: Sort) => void;
}

/** Heads of the columns; each is a button that sorts. */
export function BoardHead({ metrics, official, sort, onSort }: BoardHeadProps) {
  const head = (
    column: string,
    text: string,
    options: { title?: string; name?: string; number?: boolean } = {},
  ) => <SortHead key={column} column={column} text={text} sort={sort} onSort={onSort} {...options} />;
  return (
    <thead>
      {official.length > 0 ? (
        <tr className="board-groups">
          <th colSpan={2} className="board-groups__first" />
          <th />
          <th colSpan={Math.max(1, metrics.length)}>clearlines-v2</th>
          <th colSpan={official.length} className="board-official board-official--first">
            official-v1, as published
          </th>
          <th colSpan={2} className="board-scored" />
        </tr>
      ) : null}
      <tr>
        {head("rank", "Rank", { name: "board-rank" })}
        {head("method", "Method", { name: "board-method" })}
        {head("f1", "F1, 95 % interval", { title: metricOf("f1").meaning })}
        {metrics.map((key) => head(key, metricOf(key).short, { title: metricOf(key).meaning, number: true }))}
        {official.map((key, index) =>
          head(key, metricOf(key).short.replace("v1 ", ""), {
            title: metricOf(key).meaning,
            number: true,
            name: `board-official${index === 0 ? " board-official--first" : ""}`,
          }),
        )}
        {head("date", "Scored", { number: true, name: "board-scored" })}
        <th>
          <span className="visually-hidden">Links</span>
        </th>
      </tr>
    </thead>
  );
}

interface SortHeadProps {
  column: string;
  text: string;
  sort: Sort;
  onSort: (sort: Sort) => void;
  title?: string;
  /** Further class of the cell. */
  name?: string;
  number?: boolean;
}

function SortHead({ column, text, sort, onSort, title, name, number }: SortHeadProps) {
  const current = sort.column === column;
  const direction = sort.descending ? "descending" : "ascending";
  return (
    <th
      scope="col"
      className={[number ? "table__number" : "", name ?? ""].join(" ").trim()}
      aria-sort={current ? direction : "none"}
    >
      <button
        type="button"
        className="sort-head"
        title={title}
        onClick={() => onSort(nextSort(sort, column))}
      >
        {text}
        <Icon
          name={current && sort.descending ? "down" : "up"}
          size={11}
          className={current ? "sort-head__arrow" : "sort-head__arrow sort-head__arrow--idle"}
        />
      </button>
    </th>
  );
}
