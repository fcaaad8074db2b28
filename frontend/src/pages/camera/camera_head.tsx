import { Link } from "react-router";
import type { CalibrationBrief, CameraDetail, FinishedCalibration } from "../../api/camera_types";
import { useRights } from "../../api/use_rights";
import { Badge } from "../../design/badge";
import { formatCount, formatDate, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { Note } from "../note";
import { CalibrateMenu } from "./calibrate_menu";
import { expectedErrorText, FAMILIES, reasonText, releasedText, SOURCES } from "./calibration_text";
import { ExportMenu } from "./export/export_menu";
import { px } from "./length_text";
import type { CalibrationActions } from "./use_calibration_actions";
import { useCameraAddress } from "./use_camera_address";

interface CameraHeadProps {
  camera: CameraDetail;
  calibration: FinishedCalibration | null;
  active: CalibrationBrief | null;
  actions: CalibrationActions;
}

/** What the camera is and how well its lens is known, with what can be done about it. */
export function CameraHead({ camera, calibration, active, actions }: CameraHeadProps) {
  const { maintain } = useRights();
  const { name, width, height, images, images_labelled, dataset } = camera;
  return (
    <>
      <header className="board-page__header camera-head">
        <div className="board-page__title">
          <h1>{name}</h1>
          <p className="board-page__facts muted numeric">
            <span>
              {width} × {height} px
            </span>
            <Link to={`/datasets/${dataset.slug}?camera=${camera.id}`}>
              {formatQuantity(images, "image")}
            </Link>
            <span>{formatCount(images_labelled)} labelled</span>
            <span>{formatQuantity(camera.kept_lines, "kept line")}</span>
          </p>
        </div>
        <div className="board-page__actions">
          {calibration ? <ExportMenu camera={camera} calibration={calibration} /> : null}
          {maintain ? <CalibrateMenu camera={camera} active={active} actions={actions} /> : null}
        </div>
      </header>
      {calibration ? <Verdict camera={camera} calibration={calibration} /> : null}
    </>
  );
}

function Verdict({ camera, calibration }: { camera: CameraDetail; calibration: FinishedCalibration }) {
  const { result, source, finished_at } = calibration;
  const { accepted, reasons, warnings, uncertainty, counts, lens, released } = result;
  const { linkTo } = useCameraAddress();
  const latest = camera.latest_calibration_id === calibration.id;
  const figures: [string, string, string][] = [
    ["Size of the correction", px(uncertainty.correction), "RMS over the frame"],
    [
      "Lines that fit",
      formatCount(counts.inliers),
      `of ${formatCount(counts.used)} in ${formatQuantity(counts.images, "image")}`,
    ],
    ["Noise of a point", px(result.noise), "across its line"],
    ["Model", FAMILIES[lens.family].name, releasedText(released)],
  ];
  return (
    <section className="verdict card" aria-label="How well the lens is known">
      <div className="verdict__words">
        {accepted ? (
          <Badge tone="success" icon="check">
            Lens accepted
          </Badge>
        ) : (
          <Badge tone="warning" icon="warning">
            Lens refused
          </Badge>
        )}
        <p className="verdict__error numeric">{expectedErrorText(uncertainty)}</p>
        <p className="muted numeric">
          Calibration {calibration.id} from {SOURCES[source]}
          {finished_at ? `, ${formatDate(finished_at)}` : ""}
          {latest ? null : (
            <>
              {" · "}
              <Link to={linkTo({ calibration: null })}>Show the latest</Link>
            </>
          )}
        </p>
      </div>
      {reasons.length > 0 ? (
        <ul className="verdict__reasons">
          {reasons.map((reason) => (
            <li key={reason}>
              <Icon name={accepted ? "info" : "warning"} /> {reasonText(reason)}
            </li>
          ))}
        </ul>
      ) : null}
      <dl className="verdict__figures">
        {figures.map(([name, value, note]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>
              <strong className="numeric">{value}</strong>
              <span className="muted numeric">{note}</span>
            </dd>
          </div>
        ))}
      </dl>
      {warnings.length > 0 ? (
        <ul className="verdict__warnings">
          {warnings.map(({ code, message }) => (
            <li key={code}>
              <Icon name="warning" /> {reasonText(message)}
            </li>
          ))}
        </ul>
      ) : null}
      {latest && camera.decisions_since > 0 ? (
        <Note>
          <span className="numeric">Labels changed since: {formatCount(camera.decisions_since)}.</span> A new
          calibration takes them in; this one stays as it is.
        </Note>
      ) : null}
    </section>
  );
}
