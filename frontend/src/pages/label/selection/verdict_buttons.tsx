import type { Verdict } from "../../../api/types";
import { Icon, type IconName } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import { useJudging } from "../people/judging";
import "./verdict_buttons.css";

const BUTTONS: readonly { verdict: Verdict; label: string; caps: string; icon: IconName }[] = [
  { verdict: "keep", label: "Keep", caps: "K", icon: "check" },
  { verdict: "reject", label: "Reject", caps: "X", icon: "cross" },
  { verdict: "ambiguous", label: "Ambiguous", caps: "A", icon: "question" },
  { verdict: "undecided", label: "Undecided", caps: "U", icon: "circle" },
];

interface VerdictButtonsProps {
  /** Of the selected candidates; null where nothing is selected. */
  current: Verdict | "several" | null;
  onJudge: (verdict: Verdict) => void;
}

export function VerdictButtons({ current, onJudge }: VerdictButtonsProps) {
  const { judges, why } = useJudging();
  return (
    <fieldset className="verdict-buttons" disabled={current === null || !judges} title={why ?? undefined}>
      <legend className="visually-hidden">Verdict on the selected candidate</legend>
      {BUTTONS.map(({ verdict, label, caps, icon }) => (
        <button
          key={verdict}
          type="button"
          className={`verdict-button verdict-button--${verdict}`}
          aria-pressed={current === verdict}
          aria-keyshortcuts={caps}
          onClick={() => onJudge(verdict)}
        >
          <Icon name={icon} />
          <span>{label}</span>
          <Keys keys={[caps]} />
        </button>
      ))}
    </fieldset>
  );
}
