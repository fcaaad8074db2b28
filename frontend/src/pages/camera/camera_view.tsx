import { Suspense, useMemo, useState } from "react";
import { Link } from "react-router";
import type { CalibrationDetail, CameraDetail, FinishedCalibration } from "../../api/camera_types";
import { LoadingState } from "../../design/states";
import { useHotkeys } from "../use_hotkeys";
import { PART_NAMES, PARTS, type Part } from "./camera_address";
import { CameraHead } from "./camera_head";
import { CameraKeys } from "./camera_keys";
import { ShownPart } from "./shown_part";
import { useCalibrationActions } from "./use_calibration_actions";
import { useCalibrations, useShownCalibration } from "./use_calibrations";
import { useCameraAddress } from "./use_camera_address";
import { WorkStrip } from "./work_strip";

/** These can be looked at while there is no calibration. */
const ALWAYS: readonly Part[] = ["history", "reference"];

export function CameraView({ camera }: { camera: CameraDetail }) {
  const { part, calibration: asked, set } = useCameraAddress();
  const { history, active, lost } = useCalibrations(camera);
  const { id, query } = useShownCalibration(asked, history.data);
  // What is begun is shown as soon as it is done.
  const actions = useCalibrationActions(camera, () => set({ calibration: null }));
  const [keyList, setKeyList] = useState(false);
  const calibration = useMemo(() => finished(query.data), [query.data]);
  const [newest] = history.data ?? [];
  useHotkeys({
    ...Object.fromEntries(PARTS.map((name, place) => [String(place + 1), () => set({ part: name }, false)])),
    "?": () => setKeyList((shown) => !shown),
    ...(keyList ? { escape: () => setKeyList(false) } : {}),
  });
  return (
    <article className="camera-page">
      <CameraHead camera={camera} calibration={calibration} active={active} actions={actions} />
      {active ? <WorkStrip calibration={active} lost={lost} actions={actions} /> : null}
      {newest?.status === "failed" ? <WorkStrip calibration={newest} lost={false} actions={actions} /> : null}
      <Parts part={part} open={calibration !== null} />
      <Suspense fallback={<LoadingState label="Loading" />}>
        <ShownPart
          camera={camera}
          part={part}
          history={history}
          asked={{ id, query }}
          calibration={calibration}
          active={active}
          actions={actions}
        />
      </Suspense>
      {keyList ? <CameraKeys onClose={() => setKeyList(false)} /> : null}
    </article>
  );
}

function Parts({ part, open }: { part: Part; open: boolean }) {
  const { linkTo } = useCameraAddress();
  return (
    <nav className="tabs camera-page__parts" aria-label="Parts of the camera">
      {PARTS.map((name, place) => (
        <Link
          key={name}
          className={`tabs__tab${open || ALWAYS.includes(name) ? "" : " camera-page__part--later"}`}
          to={linkTo({ part: name })}
          preventScrollReset
          title={`Key ${place + 1}`}
          aria-current={name === part ? "page" : undefined}
        >
          {PART_NAMES[name]}
        </Link>
      ))}
    </nav>
  );
}

function finished(detail: CalibrationDetail | undefined): FinishedCalibration | null {
  return detail?.status === "done" && detail.result !== null ? { ...detail, result: detail.result } : null;
}
