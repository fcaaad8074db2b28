import { useEffect, useMemo, useState } from "react";
import type { LineOrder } from "../../../api/camera_types";
import { Bars } from "../../../charts/bars";
import { formatCount, formatQuantity } from "../../../design/format";
import { Segmented } from "../../../design/segmented";
import { EmptyState, ErrorState } from "../../../design/states";
import { px } from "../length_text";
import type { PartProps } from "../part_props";
import { LineRows } from "./line_rows";
import { residualBars } from "./residual_bars";
import { useCalibrationLines } from "./use_calibration_lines";
import "./lines.css";

const ORDERS = [
  { value: "residual", label: "Residual" },
  { value: "length", label: "Length" },
  { value: "image", label: "Image" },
] as const;

/** So many lines are fetched for the histogram without being scrolled to. */
const COUNTED = 5_000;

/** The lines that the lens was read off, each with what is left of its bend. */
export function LinesPart({ camera, calibration }: PartProps) {
  const [order, setOrder] = useState<LineOrder>("residual");
  const { query, items, total } = useCalibrationLines(calibration.id, order);
  const { hasNextPage, isFetching, fetchNextPage } = query;
  const more = hasNextPage && !isFetching && items.length < COUNTED;
  useEffect(() => {
    if (more) void fetchNextPage();
  }, [more, fetchNextPage]);
  const bars = useMemo(() => residualBars(items.flatMap(({ rms }) => rms ?? [])), [items]);
  if (query.isError) return <ErrorState error={query.error} onRetry={() => query.refetch()} />;
  if (!query.data) {
    return (
      <div className="skeleton camera-page__loading-view" role="status" aria-label="Loading the lines" />
    );
  }
  if (total === 0) {
    return (
      <EmptyState icon="lines" title="No lines">
        None was long enough to tell anything about the lens.
      </EmptyState>
    );
  }
  return (
    <section className="lines-part" aria-label="Lines">
      <div className="section card">
        <div className="section__header">
          <h2>How straight they are after the correction</h2>
          <p className="muted numeric">
            {items.length < total
              ? `The first ${formatCount(items.length)} of ${formatQuantity(total, "line")} in this order`
              : formatQuantity(total, "line")}
            ; a point lies {px(calibration.result.noise)} off its line
          </p>
        </div>
        <Bars label="Lines by their residual" bars={bars} unit="lines" height={130} />
      </div>
      <div className="lines-part__tools">
        <span className="muted" id="lines-order">
          Sorted by
        </span>
        <Segmented label="Sorted by" name="lines-order" value={order} choices={ORDERS} onChange={setOrder} />
        <span className="muted numeric" role="status">
          {formatQuantity(total, "line")}
        </span>
      </div>
      <LineRows
        key={order}
        camera={camera}
        items={items}
        total={total}
        onEnd={() => {
          if (query.hasNextPage && !query.isFetchingNextPage) void query.fetchNextPage();
        }}
      />
    </section>
  );
}
