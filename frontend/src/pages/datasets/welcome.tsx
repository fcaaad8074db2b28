import { useState } from "react";
import { useNavigate } from "react-router";
import { Button } from "../../design/button";
import { InlineEdit } from "../../design/inline_edit";
import { FileButtons } from "../../uploads/file_buttons";
import type { Picked } from "../../uploads/picked_files";
import { useDatasetActions } from "./use_dataset_actions";
import "./welcome.css";

const STEPS = [
  ["Upload", "Images of streets, rooms, anything with straight edges: files, folders or zips."],
  ["Pre-label", "The pipeline proposes edge-segments and estimates the lens."],
  ["Keep or reject", "One key per candidate; each verdict is saved at once."],
  ["Export", "Labels in the ClearLines layout, COCO, CVAT and more."],
] as const;

/** The first page of somebody who has nothing here yet. */
export function Welcome({ onPicked }: { onPicked: (picked: Picked) => void }) {
  const [naming, setNaming] = useState(false);
  const { create } = useDatasetActions();
  const navigate = useNavigate();
  return (
    <section className="welcome">
      <h1>Turn images into ground truth for straight lines</h1>
      <p className="welcome__text muted">
        ClearLines finds edge-segments in your images, you say which of them are straight in the world, and
        you take home labels and the camera's lens distortion.
      </p>
      <div className="welcome__drop">
        <Sketch />
        <h2>Drop images, a folder or a zip here</h2>
        <p className="muted">
          PNG, JPEG, TIFF, BMP, WebP, PGM or PPM, 8 or 16 bit. They stay on this server.
        </p>
        {naming ? (
          <InlineEdit
            label="Name of the new dataset"
            value=""
            placeholder="Name of the new dataset"
            submitLabel="Create"
            close={() => setNaming(false)}
            save={async (name) => navigate(`/datasets/${(await create(name)).slug}`)}
          />
        ) : (
          <div className="welcome__actions">
            <FileButtons tone="primary" onPicked={onPicked} />
            <Button tone="quiet" icon="plus" onClick={() => setNaming(true)}>
              Empty dataset
            </Button>
          </div>
        )}
      </div>
      <ol className="welcome__steps">
        {STEPS.map(([title, text], index) => (
          <li key={title}>
            <span className="welcome__number numeric">{index + 1}</span>
            <h3>{title}</h3>
            <p className="muted">{text}</p>
          </li>
        ))}
      </ol>
    </section>
  );
}

/** A facade whose lines the lens bends, and the straight ones found in it. */
function Sketch() {
  return (
    <svg className="welcome__sketch" viewBox="0 0 240 96" aria-hidden="true" focusable="false">
      <g stroke="var(--border-strong)" strokeWidth="1.5" fill="none" opacity="0.55">
        <path d="M18 84Q12 48 22 12M222 84Q228 48 218 12M22 12Q120 2 218 12M18 84Q120 92 222 84" />
        <path d="M62 30h26v26H62zM152 30h26v26h-26zM107 30h26v26h-26z" />
      </g>
      <g stroke="var(--accent)" strokeWidth="3" strokeLinecap="round" fill="none">
        <path d="M22 12Q120 2 218 12M18 84Q120 92 222 84M88 30v26M152 30v26" />
      </g>
      <g fill="var(--surface)" stroke="var(--accent)" strokeWidth="2">
        <circle cx="22" cy="12" r="3.5" />
        <circle cx="218" cy="12" r="3.5" />
        <circle cx="18" cy="84" r="3.5" />
        <circle cx="222" cy="84" r="3.5" />
      </g>
    </svg>
  );
}
