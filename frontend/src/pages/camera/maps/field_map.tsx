import { useMemo } from "react";
import type { FrameGrid, Grid } from "../../../api/camera_types";
import { CellMap } from "../../../charts/cell_map";
import type { FrameSize } from "../../../charts/frame_cells";

interface FieldMapProps {
  label: string;
  frame: FrameSize;
  field: FrameGrid & { readonly dx: Grid; readonly dy: Grid };
  /** What an arrow of so many px says: "corrected points belong 0.3 px further". */
  text: (length: number) => string;
}

/** Displacements over the frame: arrows on their lengths. */
export function FieldMap({ label, frame, field, text }: FieldMapProps) {
  const lengths = useMemo(
    () =>
      field.dx.map((line, row) =>
        line.map((x, column) => {
          const y = field.dy[row]?.[column] ?? null;
          return x === null || y === null ? null : Math.hypot(x, y);
        }),
      ),
    [field],
  );
  return (
    <CellMap
      label={label}
      frame={frame}
      grid={field}
      values={lengths}
      spacing="decades"
      unit="px"
      text={text}
      arrows={field}
    />
  );
}
