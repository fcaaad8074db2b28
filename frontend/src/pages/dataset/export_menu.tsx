import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { exportUrl } from "../../api/endpoints";
import { asProblem, problemFrom } from "../../api/problem";
import { configurationQuery, datasetQuery } from "../../api/queries";
import type { Dataset } from "../../api/types";
import { Button } from "../../design/button";
import { formatCount, sentence } from "../../design/format";
import { Popover } from "../../design/popover";
import { saveAs } from "./save_as";

const FORMATS: Record<string, string> = {
  clearlines: "ClearLines dataset (.npy labels)",
  npz: "NumPy archives (.npz)",
  json: "JSON segments",
  coco: "COCO",
  cvat: "CVAT polylines (XML)",
  datumaro: "Datumaro",
  labelme: "labelme linestrips",
  geojson: "GeoJSON",
  csv: "CSV points",
};
const NAMES_SHOWN = 6;

interface ExportMenuProps {
  dataset: Dataset;
  onShowOpen: () => void;
}

export function ExportMenu({ dataset, onShowOpen }: ExportMenuProps) {
  return (
    <Popover label="Export" icon="download">
      {(close) => <ExportForm dataset={dataset} onShowOpen={onShowOpen} close={close} />}
    </Popover>
  );
}

function ExportForm({ dataset, onShowOpen, close }: ExportMenuProps & { close: () => void }) {
  const { slug } = dataset;
  const client = useQueryClient();
  const configuration = useQuery(configurationQuery);
  const [format, setFormat] = useState("clearlines");
  const [images, setImages] = useState(true);
  const [notDone, setNotDone] = useState<string[] | null>(null);
  const [problem, setProblem] = useState<string | null>(null);
  const [busy, setBusy] = useState(false);

  const start = async (allow_not_done: boolean) => {
    setBusy(true);
    setProblem(null);
    try {
      const address = exportUrl(slug, { format, images, allow_not_done });
      const { reviewed } = await client.fetchQuery({ ...datasetQuery(slug), staleTime: 0 });
      const refused = allow_not_done || reviewed.open === 0 ? null : await imagesNotDone(address);
      setNotDone(refused);
      if (refused === null) {
        saveAs(address);
        close();
      }
    } catch (error) {
      const { message, hint } = asProblem(error);
      setProblem([message, hint].flatMap((text) => (text ? [sentence(text)] : [])).join(" "));
    }
    setBusy(false);
  };

  return (
    <form
      className="export-form"
      onSubmit={(event) => {
        event.preventDefault();
        void start(false);
      }}
    >
      <label className="field">
        <span className="field__label">Format</span>
        <select
          className="input"
          // biome-ignore lint/a11y/noAutofocus: the menu was opened to choose here
          autoFocus
          value={format}
          onChange={(event) => {
            setFormat(event.target.value);
            setNotDone(null);
          }}
        >
          {(configuration.data?.export_formats ?? ["clearlines"]).map((name) => (
            <option key={name} value={name}>
              {FORMATS[name] ?? name}
            </option>
          ))}
        </select>
      </label>
      <label className="checkbox">
        <input type="checkbox" checked={images} onChange={(event) => setImages(event.target.checked)} />
        With the images
      </label>
      {notDone === null ? (
        <Button type="submit" tone="primary" icon="download" busy={busy}>
          Export
        </Button>
      ) : (
        <div className="export-form__refused" role="alert">
          <p>
            <strong className="numeric">
              {notDone.length === 1
                ? "1 image isn't done"
                : `${formatCount(notDone.length)} images aren't done`}
            </strong>
          </p>
          <ul className="muted">
            {notDone.slice(0, NAMES_SHOWN).map((name) => (
              <li key={name}>{name}</li>
            ))}
            {notDone.length > NAMES_SHOWN ? (
              <li>and {formatCount(notDone.length - NAMES_SHOWN)} more</li>
            ) : null}
          </ul>
          <div className="export-form__choices">
            <Button
              small
              onClick={() => {
                close();
                onShowOpen();
              }}
            >
              Show them
            </Button>
            <Button small icon="download" busy={busy} onClick={() => start(true)}>
              Export anyway
            </Button>
          </div>
        </div>
      )}
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
    </form>
  );
}

/** The names of the images that keep an export from being made; null if it would be made. */
async function imagesNotDone(address: string): Promise<string[] | null> {
  const stop = new AbortController();
  const response = await fetch(address, { signal: stop.signal });
  if (response.ok) {
    stop.abort();
    return null;
  }
  const failure = problemFrom(await response.json().catch(() => null), response);
  const names: unknown = failure.problem.details?.images;
  if (failure.problem.code === "images-not-done" && Array.isArray(names)) return names.map(String);
  throw failure;
}
