import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { useState } from "react";
import {
  calibrationExportUrl,
  exportsQuery,
  type GivenIntrinsics,
  reportUrl,
} from "../../../api/camera_endpoints";
import type { ExportOption } from "../../../api/camera_types";
import { Badge } from "../../../design/badge";
import { Button, buttonClass, IconButton } from "../../../design/button";
import { sentence } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { ErrorState } from "../../../design/states";
import { TableScroll } from "../../../design/table_scroll";
import { toast } from "../../../design/toast";
import { saveAs } from "../../dataset/save_as";
import { Note } from "../../note";
import type { PartProps } from "../part_props";
import { curlText, intrinsicsText, NOTHING_GIVEN, wholeErrorText } from "./export_text";
import { IntrinsicsForm } from "./intrinsics_form";
import "./export.css";

/** The lens in the files of other tools, each with what the conversion costs. */
export function ExportPart({ calibration }: PartProps) {
  const [given, setGiven] = useState<GivenIntrinsics>(NOTHING_GIVEN);
  const query = useQuery({ ...exportsQuery(calibration.id, given), placeholderData: keepPreviousData });
  const { data } = query;
  return (
    <div className="export-part">
      {calibration.result.accepted ? null : (
        <Note tone="warning">
          This lens was refused: it may fit its lines and still be wrong where there are none.
        </Note>
      )}
      <section className="section card" aria-labelledby="focal-length-title">
        <h2 id="focal-length-title">Focal length</h2>
        {data ? <p className="numeric">{intrinsicsText(data.intrinsics)}.</p> : null}
        <IntrinsicsForm onGiven={setGiven} />
      </section>
      <section className="section card" aria-labelledby="formats-title" aria-busy={query.isFetching}>
        <div className="section__header">
          <h2 id="formats-title">Files</h2>
          <p className="muted">
            Each tool has a model of its own: the lens is fitted anew, and what that costs is written here and
            into the file
          </p>
        </div>
        {query.isError ? (
          <ErrorState error={query.error} onRetry={() => query.refetch()} />
        ) : data ? (
          <FormatTable id={calibration.id} formats={data.formats} given={given} />
        ) : (
          <div
            className="skeleton export-part__loading"
            role="status"
            aria-label="Converting to each format"
          />
        )}
      </section>
      <section className="section card" aria-labelledby="report-title">
        <div className="section__header">
          <h2 id="report-title">Report</h2>
          <p className="muted">Everything on this page on a few sheets, for print or PDF</p>
        </div>
        <div>
          <a className={buttonClass()} href={reportUrl(calibration.id)} target="_blank" rel="noreferrer">
            <Icon name="paper" /> Open the report
          </a>
        </div>
      </section>
    </div>
  );
}

interface FormatTableProps {
  id: number;
  formats: readonly ExportOption[];
  given: GivenIntrinsics;
}

function FormatTable({ id, formats, given }: FormatTableProps) {
  return (
    <TableScroll label="Files">
      <table className="table export-table">
        <thead>
          <tr>
            <th scope="col">Format</th>
            <th scope="col">Model</th>
            <th scope="col">Conversion error</th>
            <th scope="col">
              <span className="visually-hidden">Download</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {formats.map((option) => (
            <tr key={option.format}>
              <th scope="row">
                {option.title}
                <span className="table__small export-table__file">{option.file_name}</span>
              </th>
              <td className="muted">{option.model ?? "–"}</td>
              <td>
                {option.allowed ? (
                  <span className="numeric">{wholeErrorText(option)}</span>
                ) : (
                  <div className="export-table__refused">
                    <Badge tone="warning" icon="warning">
                      Refused
                    </Badge>
                    <span className="muted">{sentence(option.reason ?? "It can't hold this lens")}</span>
                  </div>
                )}
              </td>
              <td className="export-table__actions">
                {option.allowed ? (
                  <>
                    <Button
                      small
                      icon="download"
                      aria-label={`Download ${option.title}`}
                      onClick={() => saveAs(calibrationExportUrl(id, option.format, given))}
                    >
                      Download
                    </Button>
                    <IconButton
                      small
                      icon="copy"
                      label={`Copy a curl line for ${option.title}`}
                      side="end"
                      onClick={() =>
                        void copyText(
                          curlText(
                            window.location.origin,
                            calibrationExportUrl(id, option.format, given),
                            option.file_name,
                          ),
                        )
                      }
                    />
                  </>
                ) : null}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </TableScroll>
  );
}

async function copyText(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    toast({ tone: "success", message: "Copied.", key: "curl" });
  } catch {
    // A page that isn't served over HTTPS or from this machine has no clipboard.
    toast({ message: text, key: "curl", duration: 20_000 });
  }
}
