import type { CalibrationBrief } from "../../api/camera_types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { sentence } from "../../design/format";
import { Progress } from "../../design/progress";
import { Note } from "../note";
import { isAtWork, progressText } from "./calibration_text";
import type { CalibrationActions } from "./use_calibration_actions";

interface WorkStripProps {
  calibration: CalibrationBrief;
  /** The server doesn't answer just now. */
  lost: boolean;
  actions: CalibrationActions;
}

/** A calibration that goes on, or why it failed. */
export function WorkStrip({ calibration, lost, actions }: WorkStripProps) {
  const { maintain } = useRights();
  const { id, source, family, progress, error } = calibration;
  if (!isAtWork(calibration)) {
    return (
      <Note tone="danger">
        <div className="work-strip__failed">
          <p>
            <strong>The latest calibration failed.</strong> {error ? sentence(error.message) : ""}{" "}
            {error?.hint ? sentence(error.hint) : ""}
          </p>
          {maintain ? (
            <Button small icon="retry" onClick={() => void actions.start(source, family)}>
              Try again
            </Button>
          ) : null}
        </div>
      </Note>
    );
  }
  return (
    <section className="work-strip card" aria-label="Calibration at work">
      <span className="work-strip__text numeric" role="status">
        {lost ? "The server doesn't answer; it is asked again" : progressText(progress)}
      </span>
      <Progress
        label={progressText(progress)}
        value={progress?.done ?? 0}
        total={progress !== null && progress.total > 1 ? progress.total : 0}
      />
      {maintain ? (
        <Button small icon="stop" onClick={() => void actions.cancel(id)}>
          Cancel
        </Button>
      ) : null}
    </section>
  );
}
