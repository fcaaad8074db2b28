import { IconButton } from "../../../design/button";
import type { IconName } from "../../../design/icons";
import type { DrawingActions } from "../../../labelling/drawing/commands_drawing";

type EditAction = "cutLine" | "trimLine" | "joinLines" | "extendLine";

const EDITS: readonly (readonly [action: EditAction, icon: IconName, label: string, keys: string[]])[] = [
  ["cutLine", "cut", "Cut the line where you touched it", ["C"]],
  ["trimLine", "trim", "Trim its nearer end up to there", ["Shift", "C"]],
  ["joinLines", "join", "Join the two selected lines", ["M"]],
  ["extendLine", "extend", "Extend the line along its edge", ["Shift", "L"]],
];

/** Drawing for hands that hold no keys; cut and trim act where the image was touched last. */
export function DrawButtons({ tracing, actions }: { tracing: boolean; actions: DrawingActions }) {
  return (
    <>
      <span className="tool-bar__gap" aria-hidden="true" />
      <IconButton
        icon="trace"
        label="Trace a missing line"
        keys={["L"]}
        side="after"
        aria-pressed={tracing}
        onClick={actions.toggleTrace}
      />
      {EDITS.map(([action, icon, label, keys]) => (
        <IconButton
          key={action}
          icon={icon}
          label={label}
          keys={keys}
          side="after"
          onClick={actions[action]}
        />
      ))}
    </>
  );
}
