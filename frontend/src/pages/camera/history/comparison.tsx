import { useQuery } from "@tanstack/react-query";
import { calibrationQuery } from "../../../api/camera_endpoints";
import type { CalibrationResult } from "../../../api/camera_types";
import { CellMap } from "../../../charts/cell_map";
import { ColumnHeads, numbers } from "../../../design/column_heads";
import { ErrorState } from "../../../design/states";
import { TableScroll } from "../../../design/table_scroll";
import { FAMILIES } from "../calibration_text";
import { digits, px, withSigma } from "../length_text";
import { comparedParameters } from "./compared";

/** Two calibrations of one camera side by side. */
export function Comparison({ first, second }: { first: number; second: number }) {
  const a = useQuery(calibrationQuery(first));
  const b = useQuery(calibrationQuery(second));
  const failed = a.isError ? a : b.isError ? b : null;
  if (failed) return <ErrorState error={failed.error} onRetry={() => failed.refetch()} />;
  if (!a.data?.result || !b.data?.result) {
    return <div className="skeleton maps__loading" role="status" aria-label="Loading the comparison" />;
  }
  return (
    <section className="section card" aria-labelledby="comparison-title">
      <h2 id="comparison-title">
        Calibration {first} and {second}
      </h2>
      <ComparedNumbers a={a.data.result} b={b.data.result} names={[`${first}`, `${second}`]} />
      <div className="history__maps">
        <BoundMap name={first} result={a.data.result} other={b.data.result} />
        <BoundMap name={second} result={b.data.result} other={a.data.result} />
      </div>
    </section>
  );
}

interface BoundMapProps {
  name: number;
  result: CalibrationResult;
  other: CalibrationResult;
}

/** The 95 % bound over the frame, in colours that both have in common. */
function BoundMap({ name, result, other }: BoundMapProps) {
  return (
    <div>
      <h3>Uncertainty of calibration {name}</h3>
      <CellMap
        label={`95 % bound of calibration ${name}`}
        frame={result}
        grid={result.map}
        values={result.map.sigma}
        alike={other.map.sigma}
        spacing="decades"
        unit="px, 95 % bound"
        text={(value) => `below ${px(value)} with 95 %`}
      />
    </div>
  );
}

interface ComparedNumbersProps {
  a: CalibrationResult;
  b: CalibrationResult;
  names: readonly [string, string];
}

function ComparedNumbers({ a, b, names }: ComparedNumbersProps) {
  const rows: [string, string, string, string][] = [
    ["Model", FAMILIES[a.lens.family].name, FAMILIES[b.lens.family].name, ""],
    ["Expected error, px", digits(a.uncertainty.pred), digits(b.uncertainty.pred), ratio(a, b)],
    ["95 % bound, px", digits(a.uncertainty.bound95), digits(b.uncertainty.bound95), ""],
    ["Correction, px", digits(a.uncertainty.correction), digits(b.uncertainty.correction), ""],
    ["Lines that fit", String(a.counts.inliers), String(b.counts.inliers), ""],
    ["Noise, px", digits(a.noise), digits(b.noise), ""],
    ...comparedParameters(a, b).map(({ name, first, second, sigmas }): [string, string, string, string] => [
      name,
      first === null ? "held" : withSigma(first.value, first.sigma),
      second === null ? "held" : withSigma(second.value, second.sigma),
      sigmas === null ? "" : `${digits(sigmas)} sigmas apart`,
    ]),
  ];
  return (
    <TableScroll label="Both calibrations in numbers">
      <table className="table">
        <ColumnHeads
          columns={["", numbers(`Calibration ${names[0]}`), numbers(`Calibration ${names[1]}`), ""]}
        />
        <tbody>
          {rows.map(([name, one, other, note]) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td className="table__number">{one}</td>
              <td className="table__number">{other}</td>
              <td className="muted">{note}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </TableScroll>
  );
}

function ratio(a: CalibrationResult, b: CalibrationResult): string {
  const share = a.uncertainty.pred / b.uncertainty.pred;
  if (!Number.isFinite(share) || Math.abs(share - 1) < 0.005) return "the same";
  return share < 1 ? `${Math.round(100 * (1 - share))} % less` : `${Math.round(100 * (share - 1))} % more`;
}
