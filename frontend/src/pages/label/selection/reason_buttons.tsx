import type { RejectReason } from "../../../api/types";
import { Keys } from "../../../design/kbd";
import { digitOf, REASON_NAMES, REASONS } from "../../../labelling/reasons";
import "./selection.css";

interface ReasonButtonsProps {
  /** The reason of all that is selected; null where it has none, or several. */
  current: RejectReason | null;
  disabled: boolean;
  onChoose: (reason: RejectReason) => void;
}

/** Why a candidate is rejected: one press rejects it with that reason. */
export function ReasonButtons({ current, disabled, onChoose }: ReasonButtonsProps) {
  return (
    <fieldset className="reason-buttons" disabled={disabled}>
      <legend className="visually-hidden">Reject because of</legend>
      {REASONS.map((reason) => (
        <button
          key={reason}
          type="button"
          className="reason-button"
          aria-pressed={current === reason}
          aria-keyshortcuts={digitOf(reason)}
          title={`Reject: ${REASON_NAMES[reason].toLowerCase()} (${digitOf(reason)})`}
          onClick={() => onChoose(reason)}
        >
          <Keys keys={[digitOf(reason)]} />
          {REASON_NAMES[reason]}
        </button>
      ))}
    </fieldset>
  );
}
