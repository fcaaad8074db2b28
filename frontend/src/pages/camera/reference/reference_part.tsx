import { useQueryClient } from "@tanstack/react-query";
import { useRef, useState } from "react";
import { cameraKeys, sendReference } from "../../../api/camera_endpoints";
import type { CameraDetail, FinishedCalibration, Reference } from "../../../api/camera_types";
import { updateCamera } from "../../../api/endpoints";
import { asProblem } from "../../../api/problem";
import { keys } from "../../../api/queries";
import { useRights } from "../../../api/use_rights";
import { Button } from "../../../design/button";
import { sentence } from "../../../design/format";
import { EmptyState } from "../../../design/states";
import { toast } from "../../../design/toast";
import { FileDrop } from "../../../uploads/file_drop";
import { failed } from "../../datasets/use_dataset_actions";
import { Note } from "../../note";
import { DifferenceMap } from "../maps/difference_map";
import { ReferenceNumbers } from "./reference_numbers";
import "../maps/maps.css";
import "./reference.css";

const ACCEPTED = ".yaml,.yml,.json,.xml,.txt";

interface ReferencePartProps {
  camera: CameraDetail;
  /** Null while there is none to compare with. */
  calibration: FinishedCalibration | null;
}

/** A calibration known from elsewhere, and how far this one is from it. */
export function ReferencePart({ camera, calibration }: ReferencePartProps) {
  const client = useQueryClient();
  const { maintain } = useRights();
  const input = useRef<HTMLInputElement>(null);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);

  const refresh = async () => {
    if (calibration) client.removeQueries({ queryKey: cameraKeys.difference(calibration.id) });
    await Promise.all([
      client.invalidateQueries({ queryKey: cameraKeys.camera(camera.id) }),
      client.invalidateQueries({ queryKey: keys.cameras(camera.dataset.slug) }),
    ]);
  };
  const send = async (file: File | undefined) => {
    if (!file) return;
    setBusy(true);
    setProblem(null);
    try {
      await sendReference(camera.id, file, new AbortController().signal);
      await refresh();
      toast({ tone: "success", message: "Reference taken.", key: "reference" });
    } catch (error) {
      const { message, where, expected, hint } = asProblem(error);
      setProblem(
        [message, where && `Where: ${where}`, expected && `Expected: ${expected}`, hint]
          .flatMap((text) => (text ? [sentence(text)] : []))
          .join(" "),
      );
    }
    setBusy(false);
  };
  const put = async (reference: Reference | null) => {
    try {
      await updateCamera(camera.id, { reference });
    } catch (error) {
      failed(error);
    }
    await refresh();
  };
  const remove = async () => {
    const before = camera.reference as Reference | null;
    await put(null);
    toast({
      message: "Reference removed.",
      ...(before === null ? {} : { action: { label: "Undo", run: () => void put(before) } }),
      duration: 10_000,
      key: "reference",
    });
  };

  const choose = maintain ? (
    <>
      <Button
        icon="upload"
        tone={camera.reference ? "default" : "primary"}
        busy={busy}
        onClick={() => input.current?.click()}
      >
        {camera.reference ? "Choose another file" : "Choose a file"}
      </Button>
      <input
        ref={input}
        type="file"
        hidden
        accept={ACCEPTED}
        aria-label="Calibration file"
        onChange={(event) => {
          const [file] = event.currentTarget.files ?? [];
          event.currentTarget.value = "";
          void send(file);
        }}
      />
    </>
  ) : null;

  return (
    <div className="reference">
      {problem ? <Note tone="danger">{problem}</Note> : null}
      {camera.reference ? (
        <>
          <section className="section card" aria-labelledby="reference-title">
            <div className="section__header">
              <h2 id="reference-title">Reference</h2>
              <p className="muted">In OpenCV's convention</p>
            </div>
            <ReferenceNumbers reference={camera.reference} />
            {maintain ? (
              <div className="reference__actions">
                {choose}
                <Button icon="trash" tone="quiet" onClick={() => void remove()}>
                  Remove
                </Button>
              </div>
            ) : null}
          </section>
          {calibration ? (
            <DifferenceMap camera={camera} calibration={calibration} />
          ) : (
            <p className="muted">The difference is shown here once the camera is calibrated.</p>
          )}
        </>
      ) : (
        <EmptyState icon="compare" title="No reference" actions={choose}>
          Have you calibrated this camera with a chessboard? Its file (OpenCV YAML or JSON, ROS camera_info,
          or a cameras.json) is compared with the lens from lines, place by place. Drop it anywhere here.
        </EmptyState>
      )}
      {maintain ? (
        <FileDrop
          label={`Drop a reference for ${camera.name}`}
          hint="OpenCV YAML or JSON, ROS camera_info, cameras.json"
          onPicked={({ files }) => void send(files[0]?.file)}
        />
      ) : null}
    </div>
  );
}
