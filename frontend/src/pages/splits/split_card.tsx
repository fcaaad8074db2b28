import { useQuery } from "@tanstack/react-query";
import type { ReactNode } from "react";
import { Link } from "react-router";
import { boardQuery } from "../../api/board_queries";
import type { Split } from "../../api/board_types";
import { IntervalBar } from "../../charts/interval_bar";
import { Ellipsis } from "../../design/ellipsis";
import { formatCount, formatQuantity } from "../../design/format";
import { bestRow } from "../board/board_rows";
import { intervalText, metricText } from "../metrics";
import { DeadlineBadge, VisibilityBadge } from "../split_badges";
import "./splits.css";

/** A split at a glance; the whole card leads to its board. */
export function SplitCard({ split, tools }: { split: Split; tools?: ReactNode }) {
  const { slug, name, dataset, visibility, version, submissions } = split;
  return (
    <li className="split-card card">
      <div className="split-card__title">
        <h2>
          <Link className="split-card__link" to={`/splits/${slug}`}>
            <Ellipsis text={name} />
          </Link>
        </h2>
        {tools}
      </div>
      <p className="split-card__badges">
        <VisibilityBadge visibility={visibility} />
        <DeadlineBadge split={split} />
      </p>
      <Best split={split} />
      <dl className="split-card__facts numeric">
        {dataset ? <Fact name="Dataset" value={dataset.name} /> : null}
        <Fact name="Images" value={formatCount(version.images)} />
        <Fact name="Labels" value={version.labels === null ? "Hidden" : formatCount(version.labels)} />
        <Fact name="Submissions" value={formatCount(submissions)} />
        {split.min_length > 0 ? <Fact name="From" value={`${split.min_length} px`} /> : null}
        {version.number > 1 ? <Fact name="Version" value={formatCount(version.number)} /> : null}
      </dl>
    </li>
  );
}

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd title={value}>{value}</dd>
    </div>
  );
}

function Best({ split }: { split: Split }) {
  const board = useQuery(boardQuery(split.slug, null));
  const best = board.data ? bestRow(board.data.rows) : null;
  const f1 = best?.totals.f1;
  if (board.isPending) return <div className="split-card__best skeleton" />;
  if (!best || !f1 || f1.value === null) {
    return (
      <p className="split-card__best muted">{board.isError ? "Board not available" : "Nothing scored yet"}</p>
    );
  }
  return (
    <div className="split-card__best">
      <p>
        <span className="muted">Best F1 </span>
        <strong className="split-card__f1 numeric">{metricText("f1", f1.value)}</strong>{" "}
        <span className="muted numeric">{intervalText("f1", f1)}</span>
      </p>
      <IntervalBar value={f1.value} low={f1.low} high={f1.high} domain={[0, 1]} width={220} />
      <p className="split-card__leader muted" title={best.method.name}>
        {best.method.name}
        {best.tied_with.length > 0 ? `, tied with ${formatQuantity(best.tied_with.length, "other")}` : ""}
      </p>
    </div>
  );
}
