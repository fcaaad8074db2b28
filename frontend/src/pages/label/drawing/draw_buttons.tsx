import { IconButton } from "../../../design/button";
import type { DrawingActions } from "../../../labelling/drawing/commands_drawing";

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
      <IconButton
        icon="cut"
        label="Cut the line where you touched it"
        keys={["C"]}
        side="after"
        onClick={actions.cutLine}
      />
      <IconButton
        icon="trim"
        label="Trim its nearer end up to there"
        keys={["Shift", "C"]}
        side="after"
        onClick={actions.trimLine}
      />
      <IconButton
        icon="join"
        label="Join the two selected lines"
        keys={["M"]}
        side="after"
        onClick={actions.joinLines}
      />
      <IconButton
        icon="extend"
        label="Extend the line along its edge"
        keys={["Shift", "L"]}
        side="after"
        onClick={actions.extendLine}
      />
    </>
  );
}
