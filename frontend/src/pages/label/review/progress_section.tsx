import type { Verdict } from "../../../api/types";
import type { StyleName } from "../../../canvas/style";
import { formatCount } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { VerdictBar } from "../../../design/progress";
import { judgedCount, type LabelState, type Shown } from "../../../labelling/label_state";
import { VerdictMark } from "../selection/verdict_mark";

const ROWS: readonly { verdict: Verdict; label: string }[] = [
  { verdict: "undecided", label: "Undecided" },
  { verdict: "keep", label: "Keep" },
  { verdict: "ambiguous", label: "Ambiguous" },
  { verdict: "reject", label: "Reject" },
];

interface ProgressSectionProps {
  state: LabelState;
  onShown: (shown: Shown) => void;
}

/** How far the image is, and at the same time the legend and the filter of what is drawn. */
export function ProgressSection({ state, onShown }: ProgressSectionProps) {
  const { counts, shown, candidates } = state;
  const bent = candidates.filter((candidate) => candidate.straight === false).length;
  return (
    <section className="panel-section" aria-label="Progress">
      <p className="panel-progress">
        <strong className="numeric">{formatCount(judgedCount(state))}</strong>
        <span className="muted"> of {formatCount(candidates.length)} judged</span>
      </p>
      <VerdictBar counts={counts} />
      <ul className="shown-list">
        {ROWS.map(({ verdict, label }) => (
          <ShownRow
            key={verdict}
            mark={verdict}
            label={label}
            count={counts[verdict]}
            shown={shown.verdicts[verdict]}
            onChange={(visible) => onShown({ ...shown, verdicts: { ...shown.verdicts, [verdict]: visible } })}
          />
        ))}
        {bent > 0 ? (
          <ShownRow
            mark="bent"
            label="Not straight"
            hint="Fails the straightness test under the camera's lens"
            count={bent}
            shown={shown.bent}
            onChange={(visible) => onShown({ ...shown, bent: visible })}
          />
        ) : null}
      </ul>
    </section>
  );
}

interface ShownRowProps {
  mark: StyleName;
  label: string;
  hint?: string;
  count: number;
  shown: boolean;
  onChange: (shown: boolean) => void;
}

function ShownRow({ mark, label, hint, count, shown, onChange }: ShownRowProps) {
  return (
    <li
      className={`shown-row${shown ? "" : " shown-row--hidden"}${mark === "bent" ? " shown-row--apart" : ""}`}
      title={hint}
    >
      <VerdictMark name={mark} />
      <span>{label}</span>
      <span className="shown-row__count numeric">{formatCount(count)}</span>
      <button
        type="button"
        className="button button--quiet button--small button--icon"
        aria-label={`Show ${label.toLowerCase()}`}
        aria-pressed={shown}
        onClick={() => onChange(!shown)}
      >
        <Icon name={shown ? "eye" : "eyeOff"} />
      </button>
    </li>
  );
}
