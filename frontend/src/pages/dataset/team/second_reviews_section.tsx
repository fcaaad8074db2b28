import { Link } from "react-router";
import type { SecondReviews } from "../../../api/team_endpoints";
import { Badge } from "../../../design/badge";
import { buttonClass } from "../../../design/button";
import { ColumnHeads } from "../../../design/column_heads";
import { formatCount, formatDay, formatQuantity } from "../../../design/format";
import { TableScroll } from "../../../design/table_scroll";

const MOST = 12;

/** Images that a second person judges without seeing the first verdicts. */
export function SecondReviewsSection({ slug, seconds }: { slug: string; seconds: SecondReviews }) {
  const { share, due, due_total, reviews } = seconds;
  const mine = reviews.find((review) => review.mine && review.status === "open");
  const next = mine?.image_id ?? due[0]?.image_id;
  return (
    <section className="section card" aria-labelledby="seconds-title">
      <header className="section__header">
        <h2 id="seconds-title">Second reviews</h2>
        {next === undefined ? null : (
          <Link className={buttonClass("primary", true)} to={`/datasets/${slug}/second/${next}`}>
            {mine ? "Go on with yours" : "Begin the next"}
          </Link>
        )}
      </header>
      <p className="muted">
        {share === 0 && reviews.length === 0
          ? "The rules ask for none. A share of the images judged by a second person shows how far verdicts can be trusted."
          : due_total > 0
            ? `${formatQuantity(due_total, "image")} that somebody else has finished wait for you.`
            : "No image waits for you: those that the rules choose are yours already, not finished, or taken."}
      </p>
      {reviews.length === 0 ? null : (
        <TableScroll label="Second reviews">
          <table className="table">
            <ColumnHeads columns={["Image", "Person", "State", "Begun"]} />
            <tbody>
              {reviews.slice(0, MOST).map((review) => (
                <tr key={review.id}>
                  <th scope="row" className="team__name" title={review.name}>
                    {review.mine ? (
                      <Link to={`/datasets/${slug}/second/${review.image_id}`}>{review.name}</Link>
                    ) : (
                      review.name
                    )}
                  </th>
                  <td>{review.mine ? "You" : (review.person ?? "–")}</td>
                  <td>
                    <Badge tone={review.status === "done" ? "success" : "neutral"}>
                      {review.status === "done" ? "Done" : "Open"}
                    </Badge>
                  </td>
                  <td className="muted">{formatDay(review.created_at)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </TableScroll>
      )}
      {reviews.length > MOST ? (
        <p className="muted numeric">{formatCount(reviews.length - MOST)} more</p>
      ) : null}
    </section>
  );
}
