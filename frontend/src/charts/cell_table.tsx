import { useState } from "react";
import { TableScroll } from "../design/table_scroll";
import type { CellMapGrid } from "./cell_map";

interface CellTableProps {
  label: string;
  grid: CellMapGrid;
  values: readonly (readonly (number | null)[])[];
}

/** The numbers of a map, for those who read them rather than look; made once they are asked for. */
export function CellTable({ label, grid, values }: CellTableProps) {
  const [open, setOpen] = useState(false);
  return (
    <details className="cell-map__table" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>As a table</summary>
      {open ? (
        <TableScroll label={label}>
          <table className="cell-table numeric">
            <caption className="visually-hidden">{label}, by the middles of the cells in px</caption>
            <thead>
              <tr>
                <th scope="col">y \ x</th>
                {grid.x.map((x) => (
                  <th key={x} scope="col">
                    {Math.round(x)}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {grid.y.map((y, row) => (
                <tr key={y}>
                  <th scope="row">{Math.round(y)}</th>
                  {grid.x.map((x, column) => (
                    <td key={x}>{shortNumber(values[row]?.[column] ?? Number.NaN)}</td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </TableScroll>
      ) : null}
    </details>
  );
}

function shortNumber(value: number): string {
  if (!Number.isFinite(value)) return "–";
  return value >= 100 ? value.toFixed(0) : value.toFixed(2);
}
