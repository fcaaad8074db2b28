import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { calibrationExportUrl, exportsQuery, reportUrl } from "../../../api/camera_endpoints";
import { asProblem } from "../../../api/problem";
import { sentence } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { Popover } from "../../../design/popover";
import { saveAs } from "../../dataset/save_as";
import type { PartProps } from "../part_props";
import { useCameraAddress } from "../use_camera_address";
import { errorText, intrinsicsText, NOTHING_GIVEN } from "./export_text";

/** The files that other tools read, one press away; the rest of it is on the export part. */
export function ExportMenu(props: PartProps) {
  return (
    <Popover label="Export" icon="download">
      {(close) => <Formats {...props} close={close} />}
    </Popover>
  );
}

function Formats({ calibration, close }: PartProps & { close: () => void }) {
  const { linkTo } = useCameraAddress();
  const { data, error } = useQuery(exportsQuery(calibration.id, NOTHING_GIVEN));
  return (
    <div className="export-list">
      {error ? <p className="field__error">{sentence(asProblem(error).message)}</p> : null}
      {!data && !error ? (
        <p className="export-list__note muted" role="status">
          <span className="spinner" aria-hidden="true" /> Converting to each format
        </p>
      ) : null}
      {calibration.result.accepted ? null : (
        <p className="export-list__note export-list__refused">
          <Icon name="warning" /> This lens was refused
        </p>
      )}
      {data ? <p className="export-list__note muted numeric">{intrinsicsText(data.intrinsics)}</p> : null}
      <ul>
        {data?.formats.map((option) => (
          <li key={option.format}>
            <button
              type="button"
              className="menu-item export-list__item"
              aria-disabled={!option.allowed}
              title={option.reason ?? option.file_name}
              onClick={() => {
                if (!option.allowed) return;
                saveAs(calibrationExportUrl(calibration.id, option.format, NOTHING_GIVEN));
                close();
              }}
            >
              <span>{option.title}</span>
              <span className="muted numeric">{errorText(option)}</span>
            </button>
          </li>
        ))}
      </ul>
      <div className="export-list__foot">
        <Link className="menu-item" to={linkTo({ part: "export" })} onClick={close}>
          <Icon name="more" /> Focal length, reasons, curl
        </Link>
        <a className="menu-item" href={reportUrl(calibration.id)} target="_blank" rel="noreferrer">
          <Icon name="paper" /> Printable report
        </a>
      </div>
    </div>
  );
}
