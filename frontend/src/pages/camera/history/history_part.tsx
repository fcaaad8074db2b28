import type { CalibrationBrief, CameraDetail } from "../../../api/camera_types";
import { useRights } from "../../../api/use_rights";
import { ErrorHistory } from "../../../charts/error_history";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { EmptyState } from "../../../design/states";
import { TableScroll } from "../../../design/table_scroll";
import type { CalibrationActions } from "../use_calibration_actions";
import { useCameraAddress } from "../use_camera_address";
import { Comparison } from "./comparison";
import { DeletedCalibrations } from "./deleted_calibrations";
import { HistoryRow } from "./history_row";
import { RunEstimate } from "./run_estimate";
import "./history.css";

interface HistoryPartProps {
  camera: CameraDetail;
  history: readonly CalibrationBrief[];
  actions: CalibrationActions;
}

/** All calibrations of a camera, how they became better, and two side by side. */
export function HistoryPart({ camera, history, actions }: HistoryPartProps) {
  const { calibration: asked, other, set, linkTo } = useCameraAddress();
  const { maintain } = useRights();
  const shown = asked ?? camera.latest_calibration_id;
  const done = history.filter(({ summary }) => summary !== null);
  const points = [...done].reverse().flatMap(({ id, summary, finished_at, created_at }) =>
    summary === null
      ? []
      : [
          {
            id,
            time: Date.parse(finished_at ?? created_at),
            value: summary.pred,
            bound: summary.bound95,
            accepted: summary.accepted,
          },
        ],
  );
  return (
    <div className="history">
      {history.length === 0 ? (
        <EmptyState icon="clock" title="No calibrations yet">
          Each one stays here with what it was made from, so that one sees what further labels bring.
        </EmptyState>
      ) : (
        <>
          {points.length > 1 ? (
            <section className="section card" aria-labelledby="history-title">
              <div className="section__header">
                <h2 id="history-title">Expected error over time</h2>
                <p className="muted">Up to the 95 % bound; squares weren't accepted</p>
              </div>
              <ErrorHistory
                points={points}
                current={shown}
                onOpen={(id) => set({ calibration: id, part: "image" }, false)}
              />
            </section>
          ) : null}
          <section className="section card" aria-labelledby="calibrations-title">
            <div className="section__header">
              <h2 id="calibrations-title">Calibrations</h2>
              <p className="muted">Choose one to compare it with the one that is shown</p>
            </div>
            <TableScroll label="Calibrations">
              <table className="table">
                <ColumnHeads
                  columns={[
                    "Calibration",
                    "",
                    "Model",
                    numbers("Lines"),
                    numbers("Expected error, px"),
                    numbers("95 % bound, px"),
                    "",
                  ]}
                />
                <tbody>
                  {history.map((entry) => (
                    <HistoryRow
                      key={entry.id}
                      entry={entry}
                      shown={entry.id === shown}
                      compared={entry.id === other}
                      to={linkTo({ calibration: entry.id, part: "image", other: null })}
                      onCompare={() => set({ other: entry.id === other ? null : entry.id })}
                      onRemove={() => {
                        if (entry.id === asked) set({ calibration: null });
                        void actions.remove(entry.id);
                      }}
                    />
                  ))}
                </tbody>
              </table>
            </TableScroll>
          </section>
          {other !== null && shown !== null && other !== shown ? (
            <Comparison first={shown} second={other} />
          ) : null}
        </>
      )}
      {maintain ? <DeletedCalibrations camera={camera} actions={actions} /> : null}
      <RunEstimate camera={camera} />
    </div>
  );
}
