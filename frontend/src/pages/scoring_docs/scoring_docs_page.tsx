import { Link } from "react-router";
import { ColumnHeads } from "../../design/column_heads";
import { PageFrame } from "../../design/page_frame";
import { TableScroll } from "../../design/table_scroll";
import { METRIC_GROUPS } from "../metric_groups";
import { CasePicture } from "./case_picture";
import { CASES, type ScoringCase } from "./cases";
import { FormatsSection } from "./formats_section";
import "../board_page.css";
import "./scoring_docs.css";

/** What counts and what doesn't, what the numbers say, and in which form results are taken. */
export function ScoringDocsPage() {
  return (
    <PageFrame crumbs={[{ label: "Leaderboards", to: "/splits" }, { label: "How results are scored" }]}>
      <article className="board-page scoring-docs">
        <header className="board-page__title">
          <h1>How results are scored</h1>
          <p className="muted">
            A score is a number under a named protocol. The rank goes by F1 under clearlines-v2; what the
            paper's own script would say stands beside it.
          </p>
          <nav className="scoring-docs__contents" aria-label="On this page">
            <a href="#counts">What counts</a>
            <a href="#metrics">Metrics</a>
            <a href="#uncertainty">Uncertainty</a>
            <a href="#formats">Formats</a>
            <a href="#hidden">Hidden splits</a>
            <Link to="/docs/api">REST API</Link>
          </nav>
        </header>
        <Counts />
        <Metrics />
        <Uncertainty />
        <FormatsSection />
        <Hidden />
      </article>
    </PageFrame>
  );
}

function Counts() {
  return (
    <section className="scoring-docs__section" aria-labelledby="counts">
      <h2 id="counts">What counts</h2>
      <p>
        Every line is sampled at 1 px. A sample is near when it lies within 3 px of the other line and the two
        run within 15 degrees of each other. Prediction and label match where near length, as a share of both
        together, is at least one half; each line matches once, as many pairs as possible. It is the same at
        every angle.
      </p>
      <ul className="cases">
        {CASES.map((shown) => (
          <Case key={shown.title} shown={shown} />
        ))}
      </ul>
      <p className="scoring-docs__legend muted">
        <span className="case-key case-key--label" /> label, with its 3 px
        <span className="case-key case-key--found" /> found
        <span className="case-key case-key--wrong" /> false positive
        <span className="case-key case-key--ignored" /> not scored
      </p>
    </section>
  );
}

function Case({ shown }: { shown: ScoringCase }) {
  const { title, says, tp, fp, fn, official_precision, official_recall } = shown;
  return (
    <li className="case card">
      <CasePicture shown={shown} />
      <h3>{title}</h3>
      <p className="muted">{says}</p>
      <dl className="case__numbers numeric">
        <dt>clearlines-v2</dt>
        <dd>
          TP {tp}, FP {fp}, FN {fn}
        </dd>
        {official_precision === null || official_recall === null ? null : (
          <>
            <dt>official-v1</dt>
            <dd>
              P {official_precision.toFixed(1)}, R {official_recall.toFixed(1)}
            </dd>
          </>
        )}
      </dl>
    </li>
  );
}

function Metrics() {
  return (
    <section className="scoring-docs__section" aria-labelledby="metrics">
      <h2 id="metrics">Metrics</h2>
      <TableScroll label="Metrics" className="card">
        <table className="table">
          <ColumnHeads columns={["Metric", "Key", "What it says"]} />
          {METRIC_GROUPS.map(({ title, protocol, note, metrics }) => (
            <tbody key={title}>
              <tr>
                <th scope="rowgroup" colSpan={3}>
                  {title}, {protocol} <span className="table__small">{note}</span>
                </th>
              </tr>
              {metrics.map(({ key, name, meaning }) => (
                <tr key={key}>
                  <td>{name}</td>
                  <td>
                    <code>{key}</code>
                  </td>
                  <td className="muted">{meaning}</td>
                </tr>
              ))}
            </tbody>
          ))}
        </table>
      </TableScroll>
    </section>
  );
}

function Uncertainty() {
  return (
    <section className="scoring-docs__section" aria-labelledby="uncertainty">
      <h2 id="uncertainty">Uncertainty</h2>
      <p>
        Another set of images would have given other numbers. The intervals say how different: 95 % of 2,000
        bootstrap draws over images, images of one sequence together. Two methods are compared on the same
        draws; where the interval of their difference holds 0 they are tied, and a rank is an interval
        accordingly.
      </p>
    </section>
  );
}

function Hidden() {
  return (
    <section className="scoring-docs__section" aria-labelledby="hidden">
      <h2 id="hidden">Hidden splits</h2>
      <p>
        Where labels are hidden, rounded totals and their intervals are all that is shown: a verdict on a
        single image or segment, a picture, a stratum or an AP would let labels be read. Submissions per day
        are limited, and a new best appears only once it is beyond the noise of the old one (Blum and Hardt,
        2015). What isn't valid or fails to be scored counts for no limit.
      </p>
    </section>
  );
}
