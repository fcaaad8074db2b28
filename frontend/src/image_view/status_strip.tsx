import type { ReactNode } from "react";
import { IconButton } from "../design/button";
import { Keys } from "../design/kbd";
import type { ImagePageActions, ViewActions } from "./commands";

/** Keys and what they do, in a word. */
export type KeyHint = readonly [key: string, what: string];

interface StatusStripProps {
  hints: readonly KeyHint[];
  /** Comes before the keys. */
  tip?: ReactNode;
  scale: number;
  actions: ViewActions & Pick<ImagePageActions, "toggleKeyList">;
}

/** The keys one needs most, and the zoom, below the image. */
export function StatusStrip({ hints, tip, scale, actions }: StatusStripProps) {
  return (
    <div className="status-strip">
      {tip}
      <ul className="status-strip__hints">
        {hints.map(([key, what]) => (
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
