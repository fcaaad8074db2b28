import type { UseQueryResult } from "@tanstack/react-query";
import { lazy } from "react";
import { Link } from "react-router";
import type {
  CalibrationBrief,
  CalibrationDetail,
  CameraDetail,
  FinishedCalibration,
} from "../../api/camera_types";
import { buttonClass } from "../../design/button";
import { ErrorState } from "../../design/states";
import type { Part } from "./camera_address";
import { NothingShown } from "./nothing_shown";
import type { CalibrationActions } from "./use_calibration_actions";
import { useCameraAddress } from "./use_camera_address";

const BeforeAfterPart = lazy(async () => ({
  default: (await import("./before_after/before_after_part")).BeforeAfterPart,
}));
const MapsPart = lazy(async () => ({ default: (await import("./maps/maps_part")).MapsPart }));
const LinesPart = lazy(async () => ({ default: (await import("./lines/lines_part")).LinesPart }));
const ParametersPart = lazy(async () => ({
  default: (await import("./parameters/parameters_part")).ParametersPart,
}));
const HistoryPart = lazy(async () => ({ default: (await import("./history/history_part")).HistoryPart }));
const ReferencePart = lazy(async () => ({
  default: (await import("./reference/reference_part")).ReferencePart,
}));
const ExportPart = lazy(async () => ({ default: (await import("./export/export_part")).ExportPart }));

interface ShownPartProps {
  camera: CameraDetail;
  part: Part;
  history: UseQueryResult<CalibrationBrief[]>;
  /** The calibration that is to be shown, as far as it is there; its id is null where there is none. */
  asked: { id: number | null; query: UseQueryResult<CalibrationDetail> };
  calibration: FinishedCalibration | null;
  active: CalibrationBrief | null;
  actions: CalibrationActions;
}

/** The part of the page that the address names, or why it can't be shown. */
export function ShownPart({ camera, part, history, asked, calibration, active, actions }: ShownPartProps) {
  const { id, query } = asked;
  if (history.data === undefined) {
    if (history.isError) return <ErrorState error={history.error} onRetry={() => history.refetch()} />;
    return <PartLoading />;
  }
  if (part === "history") return <HistoryPart camera={camera} history={history.data} actions={actions} />;
  if (part === "reference") return <ReferencePart camera={camera} calibration={calibration} />;
  if (calibration === null) {
    if (id !== null && query.isError) return <NotThere query={query} />;
    if (id !== null && query.isPending) return <PartLoading />;
    return <NothingShown camera={camera} active={active} asked={query.data ?? null} actions={actions} />;
  }
  const given = { camera, calibration };
  if (part === "image") return <BeforeAfterPart key={calibration.id} {...given} />;
  if (part === "maps") return <MapsPart {...given} />;
  if (part === "lines") return <LinesPart key={calibration.id} {...given} />;
  if (part === "parameters") return <ParametersPart {...given} />;
  return <ExportPart key={calibration.id} {...given} />;
}

function PartLoading() {
  return <div className="skeleton camera-page__loading-view" role="status" aria-label="Loading" />;
}

function NotThere({ query }: { query: UseQueryResult<CalibrationDetail> }) {
  const { linkTo } = useCameraAddress();
  return (
    <ErrorState
      error={query.error}
      onRetry={() => query.refetch()}
      actions={
        <Link className={buttonClass("primary")} to={linkTo({ calibration: null })}>
          Show the latest
        </Link>
      }
    />
  );
}
