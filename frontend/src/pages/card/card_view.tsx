import { useState } from "react";
import type { Card } from "../../api/board_types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { ColumnHeads, numbers } from "../../design/column_heads";
import { CopyButton } from "../../design/copy_button";
import { formatCount, formatQuantity } from "../../design/format";
import { VerdictBar } from "../../design/progress";
import { TableScroll } from "../../design/table_scroll";
import { metricText } from "../metrics";
import { verdictText } from "../verdict_text";
import { CardForm } from "./card_form";
import { Figure } from "./figure";

export function CardView({ slug, card }: { slug: string; card: Card }) {
  const [editing, setEditing] = useState(false);
  const { maintain: maintains } = useRights();
  return (
    <article className="board-page card-page">
      <header className="board-page__header">
        <div className="board-page__title">
          <h1>{card.name}</h1>
          <p className="muted numeric">
            {formatQuantity(card.images, "image")} · {formatQuantity(card.labels, "label")}
            {card.licence ? ` · ${card.licence}` : ""}
          </p>
          {card.description ? <p className="card-page__text">{card.description}</p> : null}
        </div>
        <div className="board-page__actions card-page__actions">
          {maintains && !editing ? (
            <Button icon="pencil" onClick={() => setEditing(true)}>
              Edit
            </Button>
          ) : null}
          <Button icon="paper" onClick={() => window.print()}>
            Print
          </Button>
        </div>
      </header>
      {editing ? <CardForm slug={slug} card={card} close={() => setEditing(false)} /> : null}
      {card.figure ? <Figure address={card.figure} size={card.sources[0]?.sizes[0]} /> : null}
      <Sources card={card} />
      <TableOne card={card} />
      <section className="section card" aria-labelledby="verdicts-title">
        <h2 id="verdicts-title">Verdicts</h2>
        <VerdictBar counts={card.verdicts} />
        <p className="muted numeric">{verdictText(card.verdicts)}</p>
      </section>
      <Terms card={card} editable={maintains} onEdit={() => setEditing(true)} />
    </article>
  );
}

function Sources({ card }: { card: Card }) {
  return (
    <section className="section card" aria-labelledby="sources-title">
      <h2 id="sources-title">Images by source</h2>
      <TableScroll label="Images by source">
        <table className="table">
          <ColumnHeads
            columns={[
              "Source",
              "Sizes, px",
              numbers("Cameras"),
              numbers("Sequences"),
              numbers("Labelled"),
              numbers("Images"),
            ]}
          />
          <tbody>
            {card.sources.map(({ source, sizes, cameras, sequences, labelled, images }) => (
              <tr key={source}>
                <th scope="row">{source ?? "Not given"}</th>
                <td className="table__small">{sizes.join(", ")}</td>
                <td className="table__number">{formatCount(cameras)}</td>
                <td className="table__number">{formatCount(sequences)}</td>
                <td className="table__number">{formatCount(labelled)}</td>
                <td className="table__number">{formatCount(images)}</td>
              </tr>
            ))}
          </tbody>
          <tfoot>
            <tr>
              <th scope="row" colSpan={4}>
                Together
              </th>
              <td className="table__number">{formatCount(card.labelled)}</td>
              <td className="table__number">{formatCount(card.images)}</td>
            </tr>
          </tfoot>
        </table>
      </TableScroll>
    </section>
  );
}

function TableOne({ card }: { card: Card }) {
  if (card.table_one.length === 0) {
    return (
      <section className="section card">
        <h2>Pre-labelling against the labels</h2>
        <p className="muted">Shown once images that were pre-labelled are done.</p>
      </section>
    );
  }
  return (
    <section className="section card" aria-labelledby="table-one-title">
      <header className="section__header">
        <h2 id="table-one-title">Pre-labelling against the labels</h2>
        <span className="muted">The paper's Table I; official-v1 unless said otherwise</span>
      </header>
      <TableScroll label="Pre-labelling against the labels">
        <table className="table">
          <ColumnHeads
            columns={[
              "Source",
              numbers("Images"),
              numbers("Precision"),
              numbers("Recall"),
              numbers("F1"),
              numbers("F1, clearlines-v2"),
            ]}
          />
          <tbody>
            {card.table_one.map((row) => (
              <tr key={row.source}>
                <th scope="row">{sourceText(row.source)}</th>
                <td className="table__number">{formatCount(row.images)}</td>
                <td className="table__number">{metricText("official_precision", row.precision)}</td>
                <td className="table__number">{metricText("official_recall", row.recall)}</td>
                <td className="table__number">{metricText("official_f1", row.f1)}</td>
                <td className="table__number">
                  <strong>{metricText("f1", row.f1_v2)}</strong>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </TableScroll>
    </section>
  );
}

function Terms({ card, editable, onEdit }: { card: Card; editable: boolean; onEdit: () => void }) {
  const { licence, citation } = card;
  if (!licence && !citation && !editable) return null;
  return (
    <section className="section card" aria-labelledby="terms-title">
      <h2 id="terms-title">Licence and citation</h2>
      <p>{licence ?? <span className="muted">No licence given.</span>}</p>
      {citation ? (
        <div className="card-citation">
          <pre className="mono">{citation}</pre>
          <CopyButton text={citation} label="Copy the citation" />
        </div>
      ) : (
        <p className="muted">No citation given.</p>
      )}
      {editable && (!licence || !citation) ? (
        <p className="card-page__actions">
          <Button small icon="pencil" onClick={onEdit}>
            Add what is missing
          </Button>
        </p>
      ) : null}
    </section>
  );
}

/** The last row of the table is of all images. */
function sourceText(source: string | null): string {
  return source === "all" ? "All" : (source ?? "Not given");
}
