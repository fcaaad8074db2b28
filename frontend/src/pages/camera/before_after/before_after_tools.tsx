import { Button, IconButton } from "../../../design/button";
import { formatQuantity } from "../../../design/format";
import type { BeforeAfterActions } from "./before_after_commands";
import { RESIDUAL_COLOURS, type ResidualScale } from "./residual_colours";

interface BeforeAfterToolsProps {
  ruler: boolean;
  shown: boolean;
  scale: number;
  /** Null where the image has no lines. */
  residuals: ResidualScale | null;
  /** null while they are on their way. */
  lines: number | null;
  /** Asks again for lines that couldn't be had. */
  onRetry: (() => void) | null;
  actions: BeforeAfterActions;
}

/** What is drawn on the image, what its colours say, and how close one looks. */
export function BeforeAfterTools({
  ruler,
  shown,
  scale,
  residuals,
  lines,
  onRetry,
  actions,
}: BeforeAfterToolsProps) {
  return (
    <div className="before-after__tools">
      <Button small icon="grid" aria-pressed={ruler} title="Key G" onClick={actions.toggleRuler}>
        Straight grid
      </Button>
      <Button small icon="lines" aria-pressed={shown} title="Key L" onClick={actions.toggleLines}>
        {lines === null ? "Lines" : formatQuantity(lines, "line")}
      </Button>
      {onRetry ? (
        <Button small tone="danger" icon="retry" onClick={onRetry}>
          The lines didn't come: try again
        </Button>
      ) : null}
      {residuals && shown ? <ResidualLegend scale={residuals} /> : null}
      <span className="before-after__view">
        <IconButton
          small
          icon="minus"
          label="Zoom out"
          keys={["−"]}
          side="end"
          onClick={() => actions.zoom(-1)}
        />
        <span className="before-after__scale numeric">{Math.round(scale * 100)}%</span>
        <IconButton
          small
          icon="plus"
          label="Zoom in"
          keys={["+"]}
          side="end"
          onClick={() => actions.zoom(1)}
        />
        <IconButton small icon="fit" label="Fit" keys={["F"]} side="end" onClick={actions.fit} />
      </span>
    </div>
  );
}

function ResidualLegend({ scale: { limits } }: { scale: ResidualScale }) {
  return (
    <ul className="residual-legend numeric" aria-label="Colours of the lines by their residual, px RMS">
      {RESIDUAL_COLOURS.map((colour, level) => (
        <li key={colour}>
          <span className="residual-legend__colour" style={{ background: colour }} aria-hidden="true" />
          {level < limits.length ? `< ${limits[level]}` : `≥ ${limits.at(-1)} px`}
        </li>
      ))}
    </ul>
  );
}
