import type { CalibrationResult } from "../../../api/camera_types";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { TableScroll } from "../../../design/table_scroll";
import { FAMILIES } from "../calibration_text";
import { digits, px, withSigma } from "../length_text";
import { parameterName } from "./parameter_names";

/** Each parameter with its sigma; those that were held at zero say so. */
export function ParameterTable({ result }: { result: CalibrationResult }) {
  const { lens, released, sigma, brown } = result;
  return (
    <>
      <TableScroll label="Parameters">
        <table className="table">
          <ColumnHeads columns={["Parameter", numbers("Value ± sigma"), numbers("Sigmas from 0"), "In px"]} />
          <tbody>
            {lens.names.map((name, place) => {
              const value = lens.parameters[place] ?? 0;
              const known = released.includes(name) ? sigma[name] : undefined;
              const centre = name === "cx" || name === "cy";
              return (
                <tr key={name} className={known === undefined ? "parameters__held" : undefined}>
                  <th scope="row">
                    {name} <span className="muted">{parameterName(name)}</span>
                  </th>
                  <td className="table__number">
                    {known === undefined ? "0, held" : withSigma(value, known)}
                  </td>
                  <td className="table__number">
                    {known === undefined || known === 0 ? "–" : digits(Math.abs(value) / known)}
                  </td>
                  <td>
                    {centre
                      ? `${withSigma(lens.center[name === "cx" ? 0 : 1], known === undefined ? known : known * lens.scale)} px`
                      : ""}
                  </td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </TableScroll>
      <p className="muted numeric">
        {FAMILIES[lens.family].name}: {FAMILIES[lens.family].hint.toLowerCase()}. Half a diagonal is{" "}
        {px(lens.scale)}.
        {lens.family === "brown"
          ? ""
          : ` In the paper's parameters: k = ${brown.k.map((k) => digits4(k)).join(", ")}, p = ${brown.p.map((p) => digits4(p)).join(", ")}, which is this lens within ${px(brown.refit_error.rms)} RMS.`}
      </p>
    </>
  );
}

function digits4(value: number): string {
  return value.toFixed(5).replace(/^-/, "−");
}
