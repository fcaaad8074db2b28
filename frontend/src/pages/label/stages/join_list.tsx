import type { StageJoin } from "../../../api/types";
import { describeJoin, px, ROUNDS } from "../../../labelling/stage_text";

interface JoinListProps {
  joins: readonly StageJoin[];
  marked: number | null;
  onMark: (join: number | null) => void;
  /** Brings a gap close. */
  onShow: (join: number) => void;
}

/** The gaps that were closed, from the candidate's start to its end; pointed at, one is ringed on the image. */
export function JoinList({ joins, marked, onMark, onShow }: JoinListProps) {
  if (joins.length === 0) return null;
  return (
    <section aria-label="Joins">
      <div className="stages__heading">
        <h3>Joins</h3>
        <span className="muted">gap, and what it counted for</span>
      </div>
      <ol className="joins">
        {joins.map((join, i) => (
          <li key={`${join.start} ${join.end}`}>
            <button
              type="button"
              className="join"
              data-marked={marked === i}
              title={ROUNDS[join.round].whole}
              onPointerEnter={() => onMark(i)}
              onPointerLeave={() => onMark(null)}
              onFocus={() => onMark(i)}
              // A click gives the focus back to the image, but the pointer is still here.
              onBlur={(event) => event.currentTarget.matches(":hover") || onMark(null)}
              onClick={() => onShow(i)}
            >
              <span className="join__number numeric">{i + 1}</span>
              <span className="join__lengths numeric">
                <span className="visually-hidden">gap </span>
                {px(join.gap)}
                <span aria-hidden="true"> → </span>
                <span className="visually-hidden">, counted as </span>
                {px(join.cost)}
              </span>
              <span className={join.flipped ? "join__how join__how--flips" : "join__how"}>
                {describeJoin(join)}
              </span>
            </button>
          </li>
        ))}
      </ol>
    </section>
  );
}

/** Moves the focus to the join after the one that has it, or before; to the first, or last, where none has. */
export function focusJoin(panel: HTMLElement | null, direction: 1 | -1): void {
  const joins: (Element | null)[] = [...(panel?.querySelectorAll(".join") ?? [])];
  const place = joins.indexOf(document.activeElement);
  const next = place < 0 && direction < 0 ? joins.length - 1 : place + direction;
  const join = joins[Math.min(Math.max(next, 0), joins.length - 1)];
  if (join instanceof HTMLElement) join.focus();
}
