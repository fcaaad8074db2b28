import { useQuery } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { Link, useNavigate, useSearchParams } from "react-router";
import { boardQuery } from "../../api/board_queries";
import type { Board, BoardRow, Measured, Split } from "../../api/board_types";
import { PrecisionRecall, type ScatterPoint } from "../../charts/precision_recall";
import { buttonClass } from "../../design/button";
import { formatCount } from "../../design/format";
import { EmptyState, ErrorState } from "../../design/states";
import { Note } from "../note";
import { BoardHeader } from "./board_header";
import { readSort, sortRows, sortText, totalOf } from "./board_rows";
import { BoardTable } from "./board_table";

const NOTHING: Measured = { value: null, low: null, high: null };

export function BoardView({ split }: { split: Split }) {
  const [parameters, setParameters] = useSearchParams();
  const wanted = Number(parameters.get("version"));
  const version = split.versions.some(({ number }) => number === wanted) ? wanted : null;
  const board = useQuery(boardQuery(split.slug, version));
  const sort = readSort(parameters.get("sort"));
  const change = (name: string, value: string | null, replace: boolean) => {
    const next = new URLSearchParams(parameters);
    if (value === null) next.delete(name);
    else next.set(name, value);
    setParameters(next, { replace, preventScrollReset: true });
  };
  return (
    <div className="board-page">
      <BoardHeader
        split={split}
        version={version}
        onVersion={(number) =>
          change("version", number === split.version.number ? null : String(number), false)
        }
      />
      {split.can.see_details ? null : <HiddenNote />}
      {board.data ? (
        board.data.rows.length === 0 ? (
          <NothingScored split={split} />
        ) : (
          <BoardContent
            board={board.data}
            sort={sort}
            onSort={(next) => change("sort", sortText(next), true)}
          />
        )
      ) : board.isError ? (
        <ErrorState error={board.error} onRetry={() => board.refetch()} />
      ) : (
        <div className="skeleton board-page__loading" role="status" aria-label="Loading the rows" />
      )}
    </div>
  );
}

interface BoardContentProps {
  board: Board;
  sort: ReturnType<typeof readSort>;
  onSort: (sort: ReturnType<typeof readSort>) => void;
}

function BoardContent({ board, sort, onSort }: BoardContentProps) {
  const [highlighted, setHighlighted] = useState<string | null>(null);
  const navigate = useNavigate();
  const rows = useMemo(() => sortRows(board.rows, sort), [board.rows, sort]);
  const points = useMemo(() => scatterPoints(board.rows), [board.rows]);
  return (
    <>
      <BoardTable
        rows={rows}
        sort={sort}
        onSort={onSort}
        highlighted={highlighted}
        onHighlight={setHighlighted}
      />
      <div className="board-below">
        <section className="section card" aria-labelledby="scatter-title">
          <h2 id="scatter-title">Precision and recall</h2>
          <PrecisionRecall
            points={points}
            highlighted={highlighted}
            onHighlight={setHighlighted}
            onOpen={navigate}
          />
        </section>
        <Reading board={board} />
      </div>
    </>
  );
}

/** How the table is meant to be read. */
function Reading({ board }: { board: Board }) {
  return (
    <section className="section card board-reading" aria-labelledby="reading-title">
      <h2 id="reading-title">How to read this board</h2>
      <dl>
        <dt>Rank</dt>
        <dd>
          An interval: 1–3 means that the images at hand can't tell whether this is the first or the third.
          Rows are tied where the interval of their difference holds 0.
        </dd>
        <dt>Interval</dt>
        <dd>
          95 %, from {formatCount(board.draws)} bootstrap draws over images; images of one sequence are drawn
          together.
        </dd>
        <dt>As published</dt>
        <dd>
          The columns official-v1 hold what the paper's own script says. It counts boxes and not one-to-one:
          five copies of one correct line reach R 5.0 and F1 1.67. Never the rank.
        </dd>
        <dt>Baselines and ceilings</dt>
        <dd>
          Baselines are put there by this server: what every detector should beat. A ceiling is how well a
          second person agrees with the labels; it isn't ranked.
        </dd>
      </dl>
    </section>
  );
}

function HiddenNote() {
  return (
    <Note icon="lock">
      <strong>The labels of this split are hidden.</strong> You see rounded totals and their intervals.
      Results per image and per segment, pictures, strata and AP aren't shown, because labels could be read
      from them; a new best appears only once it is beyond the noise.
    </Note>
  );
}

function NothingScored({ split }: { split: Split }) {
  return (
    <EmptyState
      icon="podium"
      title="Nothing scored yet"
      actions={
        split.can.submit && !split.closed ? (
          <Link to={`/splits/${split.slug}/submit`} className={buttonClass("primary")}>
            Submit results
          </Link>
        ) : null
      }
    >
      Run a detector on the images of this split and submit its segments. Checking them is free.
      <p className="board-hint">
        Baselines: <code>clearlines baseline {split.slug}</code>
      </p>
    </EmptyState>
  );
}

function scatterPoints(rows: readonly BoardRow[]): ScatterPoint[] {
  return rows.map((row) => ({
    id: row.method.slug,
    name: row.method.name,
    kind: row.method.kind,
    precision: row.totals.precision ?? NOTHING,
    recall: row.totals.recall ?? NOTHING,
    f1: totalOf(row, "f1"),
    href: row.submission_id === null ? `/methods/${row.method.slug}` : `/submissions/${row.submission_id}`,
  }));
}
