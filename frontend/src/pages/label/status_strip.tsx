import { IconButton } from "../../design/button";
import { Keys } from "../../design/kbd";
import type { LabelActions } from "../../labelling/commands";

const HINTS: readonly [string, string][] = [
  ["Tab", "next"],
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
  ["R", "reject the rest"],
  ["Enter", "done"],
];

/** The keys one needs most, and the zoom, below the image. */
export function StatusStrip({ scale, actions }: { scale: number; actions: LabelActions }) {
  return (
    <div className="status-strip">
      <ul className="status-strip__hints">
        {HINTS.map(([key, what]) => (
          <li key={key}>
            <Keys keys={[key]} /> {what}
          </li>
        ))}
      </ul>
      <div className="status-strip__view">
        <IconButton
          small
          icon="keyboard"
          label="All keys"
          keys={["?"]}
          side="up"
          onClick={actions.toggleKeyList}
        />
        <IconButton
          small
          icon="minus"
          label="Zoom out"
          keys={["−"]}
          side="up"
          onClick={() => actions.zoom(-1)}
        />
        <span className="status-strip__scale numeric">{Math.round(scale * 100)}%</span>
        <IconButton
          small
          icon="plus"
          label="Zoom in"
          keys={["+"]}
          side="up"
          onClick={() => actions.zoom(1)}
        />
        <IconButton small icon="fit" label="Fit" keys={["F"]} side="up" onClick={actions.fit} />
      </div>
    </div>
  );
}
