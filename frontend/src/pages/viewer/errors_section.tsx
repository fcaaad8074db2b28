import { Button } from "../../design/button";
import { formatCount, formatQuantity } from "../../design/format";
import { Keys } from "../../design/kbd";
import { Segmented } from "../../design/segmented";
import { ERROR_ORDER_NAMES, ERROR_ORDERS, type ErrorOrder } from "./errors";

interface ErrorsSectionProps {
  total: number;
  /** 1-based place of the selected error in the order; null where none is selected. */
  place: number | null;
  /** Whether the predictions have scores to go by. */
  scored: boolean;
  order: ErrorOrder;
  onStep: (direction: 1 | -1) => void;
  onOrder: (order: ErrorOrder) => void;
}

/** The way through the errors of the image. */
export function ErrorsSection({ total, place, scored, order, onStep, onOrder }: ErrorsSectionProps) {
  return (
    <section className="panel-section" aria-label="Errors">
      <div className="panel-heading">
        <h2>
          {place === null ? (
            formatQuantity(total, "error")
          ) : (
            <span className="numeric">
              Error {formatCount(place)} <span className="muted">of {formatCount(total)}</span>
            </span>
          )}
        </h2>
        <span className="panel-heading__end">
          <Button
            small
            icon="left"
            disabled={total === 0}
            aria-label="Previous error"
            onClick={() => onStep(-1)}
          >
            <Keys keys={["K"]} />
          </Button>
          <Button small icon="right" disabled={total === 0} aria-label="Next error" onClick={() => onStep(1)}>
            <Keys keys={["J"]} />
          </Button>
        </span>
      </div>
      <Segmented
        label="Order of errors"
        name="error-order"
        value={order}
        choices={ERROR_ORDERS.filter((value) => scored || value !== "score" || order === value).map(
          (value) => ({
            value,
            label: ERROR_ORDER_NAMES[value].short,
            title: ERROR_ORDER_NAMES[value].whole,
          }),
        )}
        onChange={onOrder}
      />
    </section>
  );
}
