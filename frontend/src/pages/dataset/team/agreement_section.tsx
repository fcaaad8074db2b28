import type { ReactNode } from "react";
import { Link } from "react-router";
import type { Agreement, Kappa } from "../../../api/team_endpoints";
import { buttonClass } from "../../../design/button";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { formatCount, formatQuantity } from "../../../design/format";
import { TableScroll } from "../../../design/table_scroll";
import { intervalText, kappaText, kappaWord } from "./kappa_text";

const MOST_IMAGES = 12;

/** How far first and second verdicts agree. */
export function AgreementSection({ slug, agreement }: { slug: string; agreement: Agreement }) {
  const { reviews, overall, differences, adjudicated } = agreement;
  const open = differences - adjudicated;
  return (
    <section className="section card" aria-labelledby="agreement-title">
      <header className="section__header">
        <h2 id="agreement-title">Agreement</h2>
        {differences === 0 ? null : (
          <Link
            className={buttonClass(open > 0 ? "primary" : "default", true)}
            to={`/datasets/${slug}/differences`}
          >
            {open > 0 ? `Decide on ${formatQuantity(open, "difference")}` : "All differences are decided"}
          </Link>
        )}
      </header>
      {reviews === 0 ? (
        <p className="muted">Shown once a second review is done.</p>
      ) : (
        <>
          <p className="team__kappa">
            <strong className="numeric">κ {kappaText(overall)}</strong>{" "}
            <span className="muted numeric">
              {intervalText(overall) ? `(${intervalText(overall)}), ` : ""}
              {kappaWord(overall)}; {share(overall.observed)} of {formatCount(overall.count)} verdicts are
              equal, {share(overall.expected)} would be by chance
            </span>
          </p>
          <div className="team__tables">
            <KappaTable
              title="By length"
              rows={agreement.lengths
                .filter(({ kappa }) => kappa.count > 0)
                .map(({ low, high, kappa }) => ({
                  key: String(low),
                  name: high === null ? `${low} px and more` : `${low} to ${high} px`,
                  kappa,
                }))}
            />
            <KappaTable
              title="By person"
              rows={agreement.people.map(({ person, kappa }) => ({
                key: person ?? "",
                name: person ?? "–",
                kappa,
              }))}
            />
            <KappaTable
              title="First and second"
              rows={agreement.pairs.map(({ first, second, kappa }) => ({
                key: `${first}/${second}`,
                name: `${first ?? "–"}, then ${second ?? "–"}`,
                kappa,
              }))}
            />
            <KappaTable
              title={agreement.images.length > MOST_IMAGES ? "Images that differ most" : "By image"}
              rows={leastFirst(agreement.images)
                .slice(0, MOST_IMAGES)
                .map(({ image_id, name, kappa }) => ({
                  key: String(image_id),
                  name: <Link to={`/datasets/${slug}/images/${image_id}`}>{name}</Link>,
                  kappa,
                }))}
            />
          </div>
        </>
      )}
    </section>
  );
}

interface KappaTableProps {
  title: string;
  rows: readonly { key: string; name: ReactNode; kappa: Kappa }[];
}

function KappaTable({ title, rows }: KappaTableProps) {
  if (rows.length === 0) return null;
  return (
    <TableScroll label={`Agreement: ${title}`}>
      <table className="table">
        <ColumnHeads columns={[title, numbers("κ"), numbers("95 %"), numbers("Verdicts")]} />
        <tbody>
          {rows.map(({ key, name, kappa }) => (
            <tr key={key}>
              <th scope="row" className="team__name">
                {name}
              </th>
              <td className="table__number" title={kappaWord(kappa)}>
                {kappaText(kappa)}
              </td>
              <td className="table__number">{intervalText(kappa) || "–"}</td>
              <td className="table__number">{formatCount(kappa.count)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </TableScroll>
  );
}

function leastFirst(images: Agreement["images"]): Agreement["images"] {
  return [...images].sort((a, b) => (a.kappa.value ?? 2) - (b.kappa.value ?? 2));
}

function share(value: number | null): string {
  return value === null ? "–" : `${Math.round(100 * value)} %`;
}
