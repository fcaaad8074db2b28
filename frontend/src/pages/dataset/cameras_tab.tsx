import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { Link } from "react-router";
import { listCameras, updateCamera } from "../../api/endpoints";
import { keys } from "../../api/queries";
import type { Camera } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Badge } from "../../design/badge";
import { IconButton } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { InlineEdit } from "../../design/inline_edit";
import { EmptyState, ErrorState } from "../../design/states";
import { CalibrationNote } from "./calibration_note";
import { type LensEstimate, largestShift, readEstimate } from "./lens";
import { LensPlot } from "./lens_plot";
import "./cameras.css";

/** So many cards ask for their latest calibration; on a longer list it is on the cameras' own pages. */
const SUMMARISED = 24;

/** The lens of each camera, as far as it is known. */
export function CamerasTab({ slug }: { slug: string }) {
  const cameras = useQuery({ queryKey: keys.cameras(slug), queryFn: () => listCameras(slug) });
  if (cameras.isError) return <ErrorState error={cameras.error} onRetry={() => cameras.refetch()} />;
  if (!cameras.data) {
    return <div className="skeleton cameras-tab__loading" role="status" aria-label="Loading cameras" />;
  }
  if (cameras.data.length === 0) {
    return (
      <EmptyState icon="camera" title="No cameras yet">
        Images that share a lens share a camera; they come with the images.
      </EmptyState>
    );
  }
  return (
    <ul className="cameras-tab">
      {cameras.data.map((camera, place) => (
        <CameraCard key={camera.id} slug={slug} camera={camera} summarised={place < SUMMARISED} />
      ))}
    </ul>
  );
}

interface CameraCardProps {
  slug: string;
  camera: Camera;
  summarised: boolean;
}

function CameraCard({ slug, camera, summarised }: CameraCardProps) {
  const estimate = readEstimate(camera.estimate);
  return (
    <li className="camera-card card">
      <CameraName slug={slug} camera={camera} />
      <p className="muted numeric">
        {camera.width} × {camera.height} px ·{" "}
        <Link to={`?camera=${camera.id}`}>{formatQuantity(camera.images, "image")}</Link>
      </p>
      {summarised ? <CalibrationNote slug={slug} camera={camera} /> : null}
      {estimate ? (
        <Estimate estimate={estimate} />
      ) : (
        <p className="camera-card__nothing muted">
          Not estimated yet: a run with one lens per camera does it.
        </p>
      )}
      {camera.reference ? <Reference reference={camera.reference} /> : null}
    </li>
  );
}

function CameraName({ slug, camera }: { slug: string; camera: Camera }) {
  const client = useQueryClient();
  const [renaming, setRenaming] = useState(false);
  const { maintain } = useRights();
  if (renaming) {
    return (
      <InlineEdit
        label="Name of the camera"
        value={camera.name}
        close={() => setRenaming(false)}
        save={async (name) => {
          await updateCamera(camera.id, { name });
          await client.invalidateQueries({ queryKey: keys.dataset(slug) });
        }}
      />
    );
  }
  return (
    <div className="camera-card__title">
      <h2>
        <Link className="camera-card__link" to={`/datasets/${slug}/cameras/${camera.id}`}>
          <Ellipsis text={camera.name} />
        </Link>
      </h2>
      {maintain ? (
        <IconButton small icon="pencil" label="Rename" side="end" onClick={() => setRenaming(true)} />
      ) : null}
    </div>
  );
}

function Estimate({ estimate }: { estimate: LensEstimate }) {
  const { accepted, reasons, k, predictedError, correction, trusted } = estimate;
  const facts: [string, string][] = [
    ["Correction", rms(correction)],
    ["Predicted error", rms(predictedError)],
    ["Largest shift", `${largestShift(estimate).toFixed(1)} px`],
    ["Straight lines used", trusted === null ? "Not known" : formatCount(trusted)],
    ["k1, k2, k3", [0, 1, 2].map((i) => coefficient(k[i])).join(", ")],
  ];
  return (
    <>
      <div className="camera-card__verdict">
        {accepted ? (
          <Badge tone="success" icon="check">
            Lens accepted
          </Badge>
        ) : (
          <Badge tone="warning" icon="warning">
            Lens refused
          </Badge>
        )}
        {reasons.map((reason) => (
          <p key={reason} className="muted">
            {sentence(reason)}
          </p>
        ))}
      </div>
      <LensPlot lens={estimate} accepted={accepted} />
      <dl className="camera-card__facts numeric">
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

function Reference({ reference }: { reference: Record<string, unknown> }) {
  const D = Array.isArray(reference.D) ? reference.D.filter((value) => typeof value === "number") : [];
  return (
    <p className="camera-card__reference muted numeric">
      <Badge tone="accent" icon="check">
        Reference known
      </Badge>{" "}
      D = {D.map((value) => value.toFixed(4)).join(", ")}
    </p>
  );
}

/** Over the frame. */
function rms(length: number | null): string {
  return length === null ? "Not known" : `${length.toFixed(2)} px RMS`;
}

function coefficient(value: number | undefined): string {
  return value === undefined ? "-" : value.toFixed(4);
}
