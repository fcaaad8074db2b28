import type { DatasetSuggestions } from "../../api/types";
import { quantityOf } from "../../labelling/suggestions/feature_words";

const MOST = 14;

/** The features that count most: to the right where more of it speaks for keeping a candidate. */
export function WeightList({ weights }: { weights: DatasetSuggestions["weights"] }) {
  const shown = weights.slice(0, MOST);
  const heaviest = Math.max(1e-9, ...shown.map(({ weight }) => Math.abs(weight)));
  return (
    <ol className="weights">
      {shown.map(({ feature, weight }) => (
        <li key={feature} className="weight">
          <span className="weight__name">{quantityOf(feature)}</span>
          <span className="weight__bar" aria-hidden="true">
            <span
              className={weight < 0 ? "weight__fill weight__fill--against" : "weight__fill"}
              style={{ width: `${(50 * Math.abs(weight)) / heaviest}%` }}
            />
          </span>
          <span className="weight__value numeric">
            {weight < 0 ? "−" : "+"}
            {Math.abs(weight).toFixed(2)}
          </span>
        </li>
      ))}
    </ol>
  );
}
