import { useState } from "react";
import { Link } from "react-router";
import type { CalibrationBrief, CalibrationSource, CameraDetail, LensFamily } from "../../api/camera_types";
import { Button } from "../../design/button";
import { Popover } from "../../design/popover";
import { calibrateText, FAMILIES } from "./calibration_text";
import type { CalibrationActions } from "./use_calibration_actions";

interface CalibrateMenuProps {
  camera: CameraDetail;
  active: CalibrationBrief | null;
  actions: CalibrationActions;
}

/** The button that calibrates, and beside it from what and with which model. */
export function CalibrateMenu({ camera, active, actions }: CalibrateMenuProps) {
  const [busy, setBusy] = useState(false);
  const none = camera.kept_lines === 0;
  const unjudged = camera.candidates > 0;
  const start = async (source: CalibrationSource, family: LensFamily | null) => {
    setBusy(true);
    await actions.start(source, family);
    setBusy(false);
  };
  return (
    <div className="calibrate">
      <div className="calibrate__buttons">
        <Button
          tone="primary"
          icon="play"
          busy={busy}
          disabled={none || active !== null}
          aria-describedby={none ? "calibrate-reason" : undefined}
          onClick={() => void start("labels", null)}
        >
          {calibrateText(camera.kept_lines)}
        </Button>
        {active === null && (unjudged || !none) ? (
          <Popover label="How to calibrate" icon="down" iconOnly>
            {(close) => (
              <HowForm
                none={none}
                unjudged={unjudged}
                onStart={(source, family) => {
                  close();
                  void start(source, family);
                }}
              />
            )}
          </Popover>
        ) : null}
      </div>
      {none && camera.images > 0 ? (
        <p id="calibrate-reason" className="muted calibrate__reason">
          No line is kept yet:{" "}
          <Link to={`/datasets/${camera.dataset.slug}?camera=${camera.id}`}>label some</Link> first.
        </p>
      ) : null}
    </div>
  );
}

function HowForm({
  none,
  unjudged,
  onStart,
}: {
  none: boolean;
  unjudged: boolean;
  onStart: (source: CalibrationSource, family: LensFamily | null) => void;
}) {
  const [source, setSource] = useState<CalibrationSource>(none ? "candidates" : "labels");
  const [family, setFamily] = useState<LensFamily | "">("");
  return (
    <form
      className="calibrate__form"
      onSubmit={(event) => {
        event.preventDefault();
        onStart(source, family === "" ? null : family);
      }}
    >
      <label className="field">
        <span className="field__label">From</span>
        <select
          className="input"
          // biome-ignore lint/a11y/noAutofocus: the menu was opened to choose here
          autoFocus
          value={source}
          onChange={(event) => setSource(event.target.value as CalibrationSource)}
        >
          <option value="labels" disabled={none}>
            Kept lines
          </option>
          <option value="candidates" disabled={!unjudged}>
            Candidates, by their scores
          </option>
        </select>
        <span className="field__hint">
          {source === "labels"
            ? "What people kept as straight"
            : "Nobody judged them: less to be trusted, but there before any label"}
        </span>
      </label>
      <label className="field">
        <span className="field__label">Model</span>
        <select
          className="input"
          value={family}
          onChange={(event) => setFamily(event.target.value as LensFamily | "")}
        >
          <option value="">The one that fits best</option>
          {Object.entries(FAMILIES).map(([key, { name }]) => (
            <option key={key} value={key}>
              {name}
            </option>
          ))}
        </select>
        {family === "" ? null : <span className="field__hint">{FAMILIES[family].hint}</span>}
      </label>
      <Button type="submit" tone="primary" icon="play">
        Calibrate
      </Button>
    </form>
  );
}
