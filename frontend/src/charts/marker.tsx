import type { MethodKind } from "../api/board_types";

/** The mark of a method, a baseline or a ceiling: told apart by shape, so that no colour is needed. */
export function Marker({ kind, x, y, size = 5 }: { kind: MethodKind; x: number; y: number; size?: number }) {
  const name = `marker marker--${kind}`;
  if (kind === "method") return <circle className={name} cx={x} cy={y} r={size} />;
  if (kind === "baseline") {
    const side = size * 1.7;
    return <rect className={name} x={x - side / 2} y={y - side / 2} width={side} height={side} />;
  }
  const reach = size * 1.3;
  return (
    <path className={name} d={`M${x} ${y - reach}L${x + reach} ${y}L${x} ${y + reach}L${x - reach} ${y}Z`} />
  );
}

/** A marker in a line of text. */
export function MarkerKey({ kind }: { kind: MethodKind }) {
  return (
    <svg width={14} height={14} aria-hidden="true" focusable="false">
      <Marker kind={kind} x={7} y={7} size={4.5} />
    </svg>
  );
}
