import type { LineStyle } from "../canvas/style";

/** A short piece of line as it is drawn on the image: the legend is the drawing itself. */
export function LineMark({ style }: { style: LineStyle }) {
  const { colour, width, dash } = style;
  return (
    <svg className="line-mark" width="30" height="14" viewBox="0 0 30 14" aria-hidden="true">
      <rect width="30" height="14" rx="3" fill="#2b313b" />
      <path
        d="M4 7h22"
        stroke={colour}
        strokeWidth={width}
        strokeDasharray={dash.length > 0 ? dash.join(" ") : undefined}
      />
    </svg>
  );
}
