import { splitForEllipsis } from "./format";

/** A name that loses its middle where it doesn't fit; the whole of it is in the tooltip. */
export function Ellipsis({ text, end }: { text: string; end?: number }) {
  const [head, tail] = splitForEllipsis(text, end);
  return (
    <span className="ellipsis" title={text}>
      <span className="ellipsis__head">{head}</span>
      {tail ? <span className="ellipsis__tail">{tail}</span> : null}
    </span>
  );
}
